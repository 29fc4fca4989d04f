// The preform of a connecting rod: two discs and a bar between them, a quarter of it (y >= 0, z >= 0). Lengths in mm.
// gmsh -3 rod.geo -format msh22 -o rod.msh
size   = 4;
half   = 12;   // half of the height
big    = 20;   // radius of the disc at x = 0
small  = 13;   // radius of the disc at x = distance
bar    = 7;    // half of the bar's width
fillet = 10;   // between disc and bar
distance = 75;

Point(1) = {0, 0, 0, size};
Point(2) = {-big, 0, 0, size};
x1 = Sqrt((big + fillet)^2 - (bar + fillet)^2);
Point(3) = {x1 * big / (big + fillet), (bar + fillet) * big / (big + fillet), 0, size};
Point(4) = {x1, bar + fillet, 0, size};
Point(5) = {x1, bar, 0, size};
x2 = Sqrt((small + fillet)^2 - (bar + fillet)^2);
Point(6) = {distance - x2, bar, 0, size};
Point(7) = {distance - x2, bar + fillet, 0, size};
Point(8) = {distance - x2 * small / (small + fillet), (bar + fillet) * small / (small + fillet), 0, size};
Point(9) = {distance, 0, 0, size};
Point(10) = {distance + small, 0, 0, size};

Circle(1) = {2, 1, 3};
Circle(2) = {3, 4, 5};
Line(3) = {5, 6};
Circle(4) = {6, 7, 8};
Circle(5) = {8, 9, 10};
Line(6) = {10, 2};
Curve Loop(1) = {-6, -5, -4, -3, -2, -1};
Plane Surface(1) = {1};
body[] = Extrude {0, 0, half} { Surface{1}; };

// body: top, volume, then the sides in the order of the loop
Physical Surface("middle") = {1};
Physical Surface("top") = {body[0]};
Physical Surface("long section") = {body[2]};
Physical Surface("small end") = {body[3]};
Physical Surface("bar") = {body[4], body[5], body[6]};
Physical Surface("big end") = {body[7]};
Physical Volume("rod") = {body[1]};

// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// Rotations one after the other. By hand: 90 degrees about y lay z down along x, and 90 degrees about z turn
// that to y; in the other order z would stay along x. Proved, too: several are the product of their matrices,
// the last one leftmost, a rotation by all means; one in the list is the same by axis and angle; what is no
// rotation is refused.

#include <retroforge/core/error.h>
#include <retroforge/geometry/rotations.h>

#include <iostream>

using namespace retroforge;

Rotations listed(const std::vector<std::vector<double>> &list)
{
  Rotations rotations;
  rotations.list = list;
  return rotations;
}

void show(const std::string &title, const Rotations &rotations)
{
  const Vec3 z = rotations.matrix() * Vec3({0., 0., 1.});
  std::cout << title << ": z becomes";
  for (unsigned int i = 0; i < 3; ++i)
    std::cout << ' ' << (std::abs(z[i]) < 1e-15 ? 0. : z[i]);
  std::cout << '\n';
}

void refuse(const Rotations &rotations)
{
  try
  {
    rotations.check("Billet");
    std::cout << "accepted\n";
  }
  catch (const Error &error)
  {
    std::cout << error.what() << '\n';
  }
}

int main()
{
  const std::vector<double> about_y = {0., 2., 0., 90.}, about_z = {0., 0., 0.1, 90.},
                            odd = {1., -2., 0.5, -77.7}, other = {-2., 1., 0.4, 143.};
  show("none", {});
  show("about y", listed({about_y}));
  show("about y, then z", listed({about_y, about_z}));
  show("about z, then y", listed({about_z, about_y}));

  const dealii::Tensor<2, 3> R = listed({odd, about_y, other}).matrix();
  const dealii::Tensor<2, 3> product =
    listed({other}).matrix() * listed({about_y}).matrix() * listed({odd}).matrix();
  std::cout << "product: " << ((R - product).norm() < 1e-15) << ", a rotation: "
            << ((transpose(R) * R - dealii::unit_symmetric_tensor<3>()).norm() < 1e-14 &&
                std::abs(determinant(R) - 1.) < 1e-14)
            << '\n';
  Rotations single;
  single.axis  = Vec3({1., -2., 0.5});
  single.angle = -77.7;
  std::cout << "one: " << ((single.matrix() - listed({odd}).matrix()).norm() == 0.) << '\n';

  refuse(listed({about_y, about_z}));
  refuse(listed({about_y, {0., 0., 1.}}));
  refuse(listed({{0., 0., 0., 30.}}));
  refuse(listed({{1e200, 0., 0., 30.}}));
  refuse(listed({{0., 0., 1., 400.}}));
  single.list = {about_y};
  refuse(single);
}

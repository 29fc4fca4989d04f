#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 The Retroforge authors
"""Parameters of the Norton-Hoff law and of Norton friction from what handbooks give; doc/manual/materials.md derives them.

    norton_hoff.py                   K and m of some steels, from published flow curves
    norton_hoff.py 1:75.7 10:110.7   K and m of a flow stress of 75.7 MPa at 1 /s and 110.7 MPa at 10 /s
    norton_hoff.py --m 0.14 --tresca 0.3 --length 10
                                     alpha of Tresca's factor 0.3 where the slip speed is 10 mm times the strain rate
    norton_hoff.py 1:75.7 10:110.7 --coulomb 0.1 --pressure 2 --slip 25 --rate 2.5
                                     K, m, and alpha of Coulomb's 0.1 where the pressure is twice the flow stress, at
                                     a slip of 25 mm/s and a strain rate of 2.5 /s

Stresses in MPa, strain rates in 1/s, slip speeds in mm/s, temperatures in degrees Celsius.
"""
import argparse
import math

# Coefficients A [MPa] and m1, m2, m4, m5, m7, m8 of Spittel's formula, of T. Spittel and M. Spittel, Metal Forming Data:
# Ferrous Alloys, Landolt-Boernstein VIII/2C1, Springer 2009, as PyRolL's flow stress plug-in has them.
STEELS = {
    "C22": (3304.39, -0.00281, 0.34766, 0.00002, -0.00130, 0.07632, 0.000148),
    "C45": (3268.49, -0.00267855, 0.34446, 0.000551814, -0.00132042, 0.0166334, 0.000149907),
    "S355J2": (2852.66, -0.00244, 0.41934, 0.00088, -0.00149, 0.12169, 0.000127),
    "11SMn30": (1473.43, -0.00239, 0.22924, -0.00870, 0.00010, -0.44065, 0.000161),
}


def flow_stress(K, m, rate):
    """sqrt(3)^(m+1) K rate^m: equivalent stress of the Norton-Hoff law at an equivalent strain rate."""
    return math.sqrt(3) ** (m + 1) * K * rate**m


def law_through(rate_1, stress_1, rate_2, stress_2):
    """K [MPa s^m] and m of the law with two given flow stresses."""
    m = math.log(stress_2 / stress_1) / math.log(rate_2 / rate_1)
    return stress_1 / (math.sqrt(3) ** (m + 1) * rate_1**m), m


def friction_of_tresca(shear_factor, m, slip, rate):
    """alpha with the traction `shear_factor` times the shear flow stress, at one slip speed and strain rate."""
    return shear_factor * (math.sqrt(3) * rate / slip) ** m


def friction_of_coulomb(coefficient, pressure_ratio, m, slip, rate):
    """alpha with the traction coefficient times pressure, the pressure given over the flow stress."""
    return friction_of_tresca(math.sqrt(3) * coefficient * pressure_ratio, m, slip, rate)


def spittel(steel, temperature, strain, rate):
    """Flow stress A exp(m1 T) e^m2 exp(m4/e) (1+e)^(m5 T) exp(m7 e) rate^(m8 T)."""
    A, m1, m2, m4, m5, m7, m8 = STEELS[steel]
    return (A * math.exp(m1 * temperature) * strain**m2 * math.exp(m4 / strain) * (1 + strain) ** (m5 * temperature)
            * math.exp(m7 * strain) * rate ** (m8 * temperature))


def shida(carbon, temperature, strain, rate):
    """Flow stress of a carbon steel in the austenite range, 0.07 to 1.2 % carbon, strains up to 0.7, rates 0.1 to 100 /s.

    S. Shida, Journal of the Japan Society for Technology of Plasticity 10 (1969).
    """
    t = (temperature + 273) / 1000
    if t < 0.95 * (carbon + 0.41) / (carbon + 0.32):
        raise ValueError(f"{temperature} degrees are below the austenite of a steel with {carbon} % carbon")
    n = 0.41 - 0.07 * carbon
    m = (-0.019 * carbon + 0.126) * t + 0.075 * carbon - 0.05
    hardness = 0.28 * math.exp(5 / t - 0.01 / (carbon + 0.05))
    return 9.81 * hardness * (1.3 * (5 * strain) ** n - 1.5 * strain) * (rate / 10) ** m


def table(strain=0.5, temperatures=(1000, 1100, 1200)):
    """The rows of the page's table, in Markdown."""
    sources = [(steel, lambda T, rate, steel=steel: spittel(steel, T, strain, rate), "Spittel") for steel in STEELS]
    sources += [(f"{carbon} % C", lambda T, rate, carbon=carbon: shida(carbon, T, strain, rate), "Shida")
                for carbon in (0.15, 0.45)]
    lines = ["| steel | °C | flow stress at 1 /s | at 10 /s | K [MPa s^m] | m | source |", "| --- | --- | --- | --- | --- | --- | --- |"]
    for steel, stress, source in sources:
        for temperature in temperatures:
            low, high = stress(temperature, 1.), stress(temperature, 10.)
            K, m = law_through(1., low, 10., high)
            lines.append(f"| {steel} | {temperature} | {low:.1f} | {high:.1f} | {K:.1f} | {m:.3f} | {source} |")
    return "\n".join(lines)


def point(text):
    rate, stress = map(float, text.split(":"))
    if not (rate > 0 and stress > 0):
        raise ValueError
    return rate, stress


def positive(text):
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not 0 < value < math.inf:
        raise argparse.ArgumentTypeError(f"{text} is no positive number")
    return value


def parse_arguments():
    parser = argparse.ArgumentParser(description="K and m of the Norton-Hoff law from two flow stresses, and alpha of its friction "
                                                 "from the factor of Tresca or Coulomb's coefficient.")
    parser.add_argument("points", nargs="*", type=point, metavar="RATE:STRESS", help="two points, in 1/s and MPa")
    parser.add_argument("--m", type=positive, help="strain rate sensitivity, instead of two points")
    law = parser.add_mutually_exclusive_group()
    law.add_argument("--tresca", type=positive, metavar="FACTOR", help="friction over the shear flow stress, up to 1")
    law.add_argument("--coulomb", type=positive, metavar="COEFFICIENT", help="friction over the contact pressure")
    parser.add_argument("--pressure", type=positive, default=1., metavar="RATIO",
                        help="contact pressure over flow stress, with --coulomb (default: 1)")
    parser.add_argument("--slip", type=positive, help="slip speed [mm/s], with --rate")
    parser.add_argument("--rate", type=positive, help="equivalent strain rate [1/s]")
    parser.add_argument("--length", type=positive, help="slip speed over strain rate [mm], instead of these two: half the radius "
                                                        "of a cylinder that is upset")
    options = parser.parse_args()
    if options.points and (len(options.points) != 2 or options.points[0][0] == options.points[1][0]):
        parser.error("give two points at different strain rates, or none for the table")
    options.of_friction = options.tresca is not None or options.coulomb is not None
    if options.of_friction:
        check_friction(parser, options)
    elif options.m or options.slip or options.rate or options.length:
        parser.error("name the friction that is converted: --tresca or --coulomb")
    return options


def check_friction(parser, options):
    if bool(options.points) == (options.m is not None):
        parser.error("give m by --m or by two points")
    if (options.length is None) == (options.slip is None) or (options.slip is None) != (options.rate is None):
        parser.error("give --length, or --slip and --rate")
    factor = options.tresca or math.sqrt(3) * options.coulomb * options.pressure
    if factor > 1:
        parser.error(f"the friction would be {factor:.3g} times the shear flow stress: beyond 1 the metal sticks and shears inside")


def main():
    options = parse_arguments()
    m = options.m
    if options.points:
        K, m = law_through(*options.points[0], *options.points[1])
        print(f"consistency {K:.6g} MPa s^m, strain rate sensitivity {m:.4g}")
    elif not options.of_friction:
        print(table())
    if options.of_friction:
        slip, rate = (options.length, 1.) if options.length else (options.slip, options.rate)
        alpha = (friction_of_tresca(options.tresca, m, slip, rate) if options.tresca else
                 friction_of_coulomb(options.coulomb, options.pressure, m, slip, rate))
        print(f"friction {alpha:.4g} mm^-m")


if __name__ == "__main__":
    main()

// SPDX-License-Identifier: GPL-3.0-or-later
// Units convert to SI by their definition, and what has another dimension or two meanings is
// refused.
#include <coracle/base/units.h>

#include "tests.h"

using namespace coracle;

void
check(const std::string &text, const std::string &unit, const double expected)
{
  const double value = parse_quantity(text, unit);
  deallog << text << " -> [" << unit << "]: " << (std::fabs(value - expected) <= 1e-14 * expected)
          << std::endl;
}

void
refused(const std::string &text, const std::string &unit)
{
  try
    {
      parse_quantities(text, unit);
      deallog << text << " NOT REFUSED" << std::endl;
    }
  catch (const UnitError &error)
    {
      deallog << error.what() << std::endl;
    }
}

void
print(const std::string &text, const std::string &unit)
{
  deallog << "'" << text << "':";
  for (const double value : parse_quantities(text, unit))
    deallog << ' ' << value;
  deallog << std::endl;
}

int
main()
{
  initlog();
  check("20 mm", "m", 0.02);
  check("20mm", "m", 0.02);
  check("1.5e2 cm", "m", 1.5);
  check("2", "m", 2);
  check("1 g/cm^3", "kg/m^3", 1000);
  check("3 kg/m^3", "kg/m^3", 3);
  check("7 N/m", "kg/s^2", 7);
  check("1 MPa", "Pa", 1e6);
  check("2 GPa", "N/m^2", 2e9);
  check("1 N/mm^2", "Pa", 1e6);
  check("1 bar", "Pa", 1e5);
  check("5 ms", "s", 5e-3);
  check("1 min", "s", 60);
  check("180 deg", "1", 3.14159265358979324);
  check("90 deg", "rad", 1.57079632679489662);
  check("2 kHz", "1/s", 2000);
  check("60 rpm", "Hz", 6.28318530717958648);
  check("3 kN", "N", 3000);
  check("9.81 m/s^2", "m s^-2", 9.81);
  check("2 Pa s", "kg/(m s)", 2);
  check("2 mPa*s", "Pa s", 2e-3);
  check("36 km/h", "m/s", 10);
  check("4 kJ/(kg K)", "J/(kg K)", 4000);
  check("5 %", "1", 0.05);
  check("1 l", "m^3", 1e-3);
  check("2 t", "kg", 2000);
  check("300 K", "K", 300);

  print("", "m");
  print("1, 2, 3", "m");
  print("1 m, 50 cm", "m");
  print("10, 0, 20 mm", "m");
  print("0, 5 mm, 0, 1 m", "m");

  refused("5 kg", "m");
  refused("5 m/s", "m/s^2");
  refused("5 kg m^4", "m");
  refused("5 m", "1");
  refused("m", "m");
  refused("1,,2", "m");
  refused("nan", "m");
  refused("0x10", "m");
  refused("5 mMPa", "Pa");
  refused("5 kK", "K");
  refused("5 J/kg K", "J/(kg K)");
  refused("5 m^", "m");
  refused("5 m^99", "m");
  refused("5 (m", "m");
  refused("5 m)", "m");
  refused("5 m/", "m");
  refused("5 ((m^12)^12)^12", "m");
  refused("5 " + std::string(17, '(') + "m", "m");
  refused("1 mm, 2, 3 mm", "m");
  refused("1 mm, 2 kg", "m");
}

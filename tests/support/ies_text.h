// SPDX-License-Identifier: Apache-2.0
// IES LM-63 files in memory.
#pragma once

#include <functional>
#include <sstream>
#include <string>
#include <vector>

namespace earthshine::tests {

struct IesText {
  std::string head = "IESNA:LM-63-2002\n[TEST] none\n[LUMINAIRE] test lamp\n";
  std::string tilt = "TILT=NONE\n";
  double multiplier = 1.0, ballast = 1.0, second = 1.0;
  int type = 1, units = 2;
  std::vector<double> vertical{0.0, 45.0, 90.0};
  std::vector<double> horizontal{0.0};
  std::function<double(double theta_deg, double phi_deg)> candela = [](double, double) {
    return 100.0;
  };

  [[nodiscard]] std::string text() const {
    std::ostringstream out;
    out.precision(17);
    out << head << tilt << "1 1000 " << multiplier << ' ' << vertical.size() << ' '
        << horizontal.size() << ' ' << type << ' ' << units << " 0.1 0.2 0\n"
        << ballast << ' ' << second << " 50\n";
    for (const double angle : vertical) out << angle << ' ';
    out << '\n';
    for (const double angle : horizontal) out << angle << ' ';
    out << '\n';
    for (const double phi : horizontal) {
      for (const double theta : vertical) out << candela(theta, phi) << ' ';
      out << '\n';
    }
    return out.str();
  }
};

// first, first + step, ... last.
inline std::vector<double> steps(double first, double last, double step) {
  std::vector<double> list;
  for (double x = first; x < last + step / 2; x += step) list.push_back(x);
  return list;
}

}  // namespace earthshine::tests

// SPDX-License-Identifier: Apache-2.0
// Cases of CIE 171:2006, "Test Cases to Assess the Accuracy of Lighting Computer Programs", that
// have analytic references. Numbers of the standard second hand, from jjathompson4/CyclesCIEtest
// (engine/cie171/test_cases.py); of case 5.7 as corrected in Ashdown's errata and the report on
// Iray, the standard's own Table 19 being wrong.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "radiosity/solution.h"

namespace earthshine::validation {

struct CiePoint {
  std::string where;
  double reference = 0.0;    // of the standard, to the digits that it prints
  double closed_form = 0.0;  // of the same quantity, worked out here
};

struct CieCase {
  std::string name;  // "5.2"
  std::string unit;
  scenes::Scene scene;
  std::vector<CiePoint> points;
  // What a solve of the scene found at a point, in the unit.
  std::function<double(const radiosity::SolveReport& report, std::size_t point)> found;
};

// 5.2, 5.3, 5.4, 5.6, 5.7 and 5.8, the last in as many scenes as three reflectances at a time make.
[[nodiscard]] std::vector<CieCase> cie_cases();

}  // namespace earthshine::validation

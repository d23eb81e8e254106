// SPDX-License-Identifier: Apache-2.0
// Cases of CIE 171:2006, "Test Cases to Assess the Accuracy of Lighting Computer Programs", with
// analytic references. The numbers are quoted from jjathompson4/CyclesCIEtest
// (engine/cie171/test_cases.py). Case 5.7 is as corrected in Ashdown's errata and the report on
// Iray, because Table 19 of the standard is wrong.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "radiosity/solution.h"

namespace earthshine::validation {

struct CiePoint {
  std::string where;
  double reference = 0.0;    // of the standard, with its printed digits
  double closed_form = 0.0;  // of the same quantity, computed here
};

struct CieCase {
  std::string name;  // "5.2"
  std::string unit;
  scenes::Scene scene;
  std::vector<CiePoint> points;
  // Result of a solve at a point, in `unit`.
  std::function<double(const radiosity::SolveReport& report, std::size_t point)> found;
};

// 5.2, 5.3, 5.4, 5.6, 5.7 and 5.8; the last one in several scenes of three reflectances each.
[[nodiscard]] std::vector<CieCase> cie_cases();

}  // namespace earthshine::validation

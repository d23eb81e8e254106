// SPDX-License-Identifier: Apache-2.0
#include "scenes/reflect/phong_fit.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <sstream>
#include <string_view>

#include "base/error.h"
#include "base/input/input_file.h"
#include "scenes/reflect/phong_least_squares.h"
#include "scenes/text/message_text.h"
#include "scenes/text/text_lines.h"

namespace earthshine::scenes {
namespace {

using base::Blame;
using base::Error;
using Points = std::span<const ReflectancePoint>;

// Points whose highlight is below this share of k_s do not determine n: rounding and noise
// dominate.
constexpr double least_lobe_share = 0.01;
constexpr double diffuse_angle_deg = 80.0;

// Mean reflectance and number of points per signed angle.
struct Reading {
  double mean = 0.0;
  int count = 0;
};
using Curve = std::map<double, Reading>;

Curve curve_of(Points points) {
  Curve curve;
  for (const ReflectancePoint& p : points) {
    Reading& reading = curve[p.angle_deg];
    reading.mean += p.reflectance;
    ++reading.count;
  }
  for (auto& [angle, reading] : curve) reading.mean /= reading.count;
  return curve;
}

// An interpolated value: its weights of each angle's mean reflectance.
using Shares = std::map<double, double>;

// Empty outside the range of the data.
Shares interpolate(const Curve& curve, double angle_deg) {
  const auto above = curve.lower_bound(angle_deg);
  if (above == curve.end()) return {};
  if (above->first == angle_deg) return {{angle_deg, 1.0}};
  if (above == curve.begin()) return {};
  const auto below = std::prev(above);
  const double t = (angle_deg - below->first) / (above->first - below->first);
  return {{below->first, 1.0 - t}, {above->first, t}};
}

// At +angle and -angle; the mean if both are measured.
Shares interpolate_both_sides(const Curve& curve, double angle_deg) {
  Shares right = interpolate(curve, angle_deg), left = interpolate(curve, -angle_deg);
  if (left.empty()) return right;
  if (right.empty()) return left;
  Shares both;
  for (const Shares& side : {right, left}) {
    for (const auto& [angle, share] : side) both[angle] += 0.5 * share;
  }
  return both;
}

double value_of(const Shares& shares, const Curve& curve) {
  double sum = 0.0;
  for (const auto& [angle, share] : shares) sum += share * curve.at(angle).mean;
  return sum;
}

// Derivative of an interpolated value by one point's reflectance.
double slope_of(const Shares& shares, const Curve& curve, double angle_deg) {
  const auto share = shares.find(angle_deg);
  return share == shares.end() ? 0.0 : share->second / curve.at(angle_deg).count;
}

struct ReportFit {
  PhongFit fit;
  std::vector<std::array<double, 3>> slopes;  // derivatives of k_d, k_s, n by each point's value
};

bool shows_lobe(const PhongFit& fit, const ReflectancePoint& p) {
  return fit.specular > 0.0 && p.angle_deg != 0.0 && std::fabs(p.angle_deg) < diffuse_angle_deg &&
         (p.reflectance - fit.diffuse) / fit.specular >= least_lobe_share;
}

ReportFit report_fit(Points points, const std::string& source) {
  const Curve curve = curve_of(points);
  const Shares at_zero = interpolate(curve, 0.0);
  const Shares at_side = interpolate_both_sides(curve, diffuse_angle_deg);
  if (at_zero.empty() || at_side.empty()) {
    throw Error(Blame::Input, source,
                fmt::format("the angles go from {:g} to {:g} degrees", curve.begin()->first,
                            std::prev(curve.end())->first),
                "k_s is read at 0 and k_d at 80 degrees", "Measure from 0 to 80 degrees");
  }
  ReportFit result;
  PhongFit& fit = result.fit;
  fit.diffuse = value_of(at_side, curve);
  fit.specular = std::max(0.0, value_of(at_zero, curve) - fit.diffuse);
  double sum = 0.0, by_diffuse = 0.0, by_specular = 0.0;
  for (const ReflectancePoint& p : points) {
    if (!shows_lobe(fit, p)) continue;
    const double log_cosine = std::log(lobe_cosine(p.angle_deg));
    sum += std::log((p.reflectance - fit.diffuse) / fit.specular) / log_cosine;
    by_diffuse -= 1.0 / ((p.reflectance - fit.diffuse) * log_cosine);
    by_specular -= 1.0 / (fit.specular * log_cosine);
    ++fit.points_used;
  }
  const double used = static_cast<double>(std::max<std::size_t>(1, fit.points_used));
  if (fit.points_used > 0) fit.shininess = sum / used;
  fit.residual = rms_residual(fit, points);
  for (const ReflectancePoint& p : points) {
    const double diffuse = slope_of(at_side, curve, p.angle_deg);
    const double specular = slope_of(at_zero, curve, p.angle_deg) - diffuse;
    double own = 0.0;
    if (shows_lobe(fit, p)) {
      own = 1.0 / ((p.reflectance - fit.diffuse) * std::log(lobe_cosine(p.angle_deg)));
    }
    result.slopes.push_back(
        {diffuse, specular, (own + by_diffuse * diffuse + by_specular * specular) / used});
  }
  return result;
}

// Propagates the noise of the points to k_d, k_s and n.
PhongErrors carried_errors(const ReportFit& report, const LeastSquaresFit& noise) {
  std::array<double, 3> variance{};
  for (std::size_t i = 0; i < report.slopes.size(); ++i) {
    for (std::size_t k = 0; k < variance.size(); ++k) {
      const double part = report.slopes[i][k] * noise.shape[i] * *noise.noise;
      variance[k] += part * part;
    }
  }
  PhongErrors errors{std::sqrt(variance[0]), {}, {}};
  if (report.fit.specular > 0.0 && noise.lobe_found) {
    errors.specular = std::sqrt(variance[1]);
    if (report.fit.points_used > 0) errors.shininess = std::sqrt(variance[2]);
  }
  return errors;
}

void note_undetermined(PhongFits& fits, const LeastSquaresFit& found) {
  const auto note = [&fits](const char* text) { fits.notes.emplace_back(text); };
  if (fits.report.specular <= 0.0) {
    note("no highlight: the reflectance at 0 degrees is not above that at 80");
  } else if (fits.report.points_used == 0) {
    note(
        "no point between 0 and 80 degrees shows the highlight, so n = 1 in the report's method "
        "says nothing");
  }
  const PhongFit& best = fits.least_squares;
  if (!found.noise) {
    note("three points fit three unknowns exactly: no standard errors; measure at more angles");
  }
  if (!found.lobe_found) {
    note(
        "least squares finds no highlight above the noise: k_s and n are not determined, k_d is "
        "the mean");
  } else if (best.shininess <= 1.01 * least_shininess) {
    note("the highlight is broader than cos^0.5: n is an upper bound");
  } else if (best.shininess >= 0.99 * most_shininess ||
             (found.noise && !best.std_error.shininess)) {
    note(
        "n is not determined, its error would exceed it: the highlight is narrower than the steps "
        "of the angle, or no broader than the noise is high");
  }
}

constexpr std::size_t max_reflectance_bytes = std::size_t{16} << 20;

// A number within [least, most] at `column` of the line.
double checked_number(std::string_view field, const base::Location& where, const char* what,
                      double least, double most) {
  const auto value = number_in(field);
  if (value && std::isfinite(*value) && *value >= least && *value <= most) return *value;
  throw Error(Blame::Input, where, fmt::format("\"{}\" is no {}", trimmed(field), what),
              fmt::format("it must be a number from {:g} to {:g}", least, most));
}

}  // namespace

double reflected_share(const PhongFit& fit) {
  return fit.diffuse + 2.0 * fit.specular / (fit.shininess + 2.0);
}

PhongFits fit_phong(Points points, const std::string& source, ReflectanceNoise noise) {
  const std::size_t angles = curve_of(points).size();
  if (angles < 3) {
    throw Error(Blame::Input, source, fmt::format("has {} different angles", angles),
                "three unknowns need at least 3", "Add measured points");
  }
  const ReportFit report = report_fit(points, source);
  const LeastSquaresFit found = fit_least_squares(points, noise);
  PhongFits fits{report.fit, found.fit, found.noise, {}};
  if (found.noise) fits.report.std_error = carried_errors(report, found);
  note_undetermined(fits, found);
  for (const PhongFit& fit : {fits.report, fits.least_squares}) {
    if (reflected_share(fit) <= 1.0) continue;
    fits.notes.emplace_back(
        fmt::format("k_d + 2 k_s / (n + 2) = {:.4g} exceeds 1: a scene refuses such a material",
                    reflected_share(fit)));
  }
  return fits;
}

std::vector<ReflectancePoint> read_reflectance(const std::filesystem::path& path) {
  std::istringstream file(base::read_input_file(path, max_reflectance_bytes, {path.string()}));
  std::vector<ReflectancePoint> points;
  std::string line;
  bool heading_possible = true;
  for (int number = 1; std::getline(file, line); ++number) {
    std::string_view row(line);
    if (number == 1 && row.starts_with("\xEF\xBB\xBF")) row.remove_prefix(3);
    const auto skipped = static_cast<std::size_t>(row.data() - line.data());
    row = row.substr(0, row.find('#'));
    if (trimmed(row).empty()) continue;
    const auto comma = row.find(',');
    if (comma == std::string_view::npos || row.find(',', comma + 1) != std::string_view::npos) {
      throw Error(Blame::Input, base::Location{path.string(), number, 0},
                  fmt::format("{} does not have two columns", in_quotes(trimmed(row))),
                  "each row is an angle in degrees, a comma and a reflectance factor");
    }
    const std::string_view angle = row.substr(0, comma), reflectance = row.substr(comma + 1);
    if (heading_possible && !number_in(angle) && !number_in(reflectance)) {
      heading_possible = false;
      continue;
    }
    heading_possible = false;
    const auto column_of = [&](std::string_view field) {
      const std::string_view text = trimmed(field);
      const char* start = text.empty() ? field.data() : text.data();
      return static_cast<int>(static_cast<std::size_t>(start - row.data()) + skipped + 1);
    };
    const base::Location at_angle{path.string(), number, column_of(angle)};
    const base::Location at_reflectance{path.string(), number, column_of(reflectance)};
    points.push_back({checked_number(angle, at_angle, "angle in degrees", -180.0, 180.0),
                      checked_number(reflectance, at_reflectance, "reflectance factor", 0.0, 1e6)});
  }
  return points;
}

}  // namespace earthshine::scenes

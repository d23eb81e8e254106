// SPDX-License-Identifier: Apache-2.0
#include "scenes/phong_fit.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <map>
#include <optional>
#include <string_view>
#include <system_error>

#include "base/error.h"
#include "base/units.h"

namespace earthshine::scenes {
namespace {

using base::Blame;
using base::Error;

// Points whose highlight is below this share of k_s say nothing about n: rounding and noise decide
// there.
constexpr double least_lobe_share = 0.01;
constexpr double diffuse_angle_deg = 80.0;
constexpr double least_shininess = 0.5;
constexpr double most_shininess = 20000.0;

double cosine(double angle_deg) {
  return std::max(0.0, std::cos(base::radians(std::fabs(angle_deg))));
}

double lobe(double angle_deg, double shininess) { return std::pow(cosine(angle_deg), shininess); }

double rms_residual(const PhongFit& fit, std::span<const ReflectancePoint> points) {
  double sum = 0.0;
  for (const ReflectancePoint& p : points) {
    const double model = fit.diffuse + fit.specular * lobe(p.angle_deg, fit.shininess);
    sum += (p.reflectance - model) * (p.reflectance - model);
  }
  return std::sqrt(sum / static_cast<double>(points.size()));
}

// ---- the report's method

// Mean reflectance per signed angle.
std::map<double, double> curve_of(std::span<const ReflectancePoint> points) {
  std::map<double, std::pair<double, int>> sums;
  for (const ReflectancePoint& p : points) {
    auto& [sum, count] = sums[p.angle_deg];
    sum += p.reflectance;
    ++count;
  }
  std::map<double, double> curve;
  for (const auto& [angle, entry] : sums) curve[angle] = entry.first / entry.second;
  return curve;
}

std::optional<double> interpolate(const std::map<double, double>& curve, double angle_deg) {
  const auto above = curve.lower_bound(angle_deg);
  if (above == curve.end()) return std::nullopt;
  if (above->first == angle_deg) return above->second;
  if (above == curve.begin()) return std::nullopt;
  const auto below = std::prev(above);
  const double t = (angle_deg - below->first) / (above->first - below->first);
  return below->second + t * (above->second - below->second);
}

// At +angle and -angle, their mean where both are measured.
std::optional<double> interpolate_both_sides(const std::map<double, double>& curve,
                                             double angle_deg) {
  const auto right = interpolate(curve, angle_deg), left = interpolate(curve, -angle_deg);
  if (right && left) return 0.5 * (*right + *left);
  return right ? right : left;
}

PhongFit report_fit(std::span<const ReflectancePoint> points, const std::string& source) {
  const std::map<double, double> curve = curve_of(points);
  const auto at_zero = interpolate(curve, 0.0);
  const auto at_side = interpolate_both_sides(curve, diffuse_angle_deg);
  if (!at_zero || !at_side) {
    throw Error(Blame::Input, source,
                fmt::format("the angles go from {:g} to {:g} degrees", curve.begin()->first,
                            std::prev(curve.end())->first),
                "k_s is read at 0 and k_d at 80 degrees", "Measure from 0 to 80 degrees");
  }
  PhongFit fit;
  fit.diffuse = *at_side;
  fit.specular = std::max(0.0, *at_zero - *at_side);
  double sum = 0.0;
  for (const ReflectancePoint& p : points) {
    const double share = (p.reflectance - fit.diffuse) / fit.specular;
    const double c = cosine(p.angle_deg);
    if (fit.specular <= 0.0 || p.angle_deg == 0.0 || std::fabs(p.angle_deg) >= diffuse_angle_deg ||
        !(share >= least_lobe_share)) {
      continue;
    }
    sum += std::log(share) / std::log(c);
    ++fit.points_used;
  }
  if (fit.points_used > 0) fit.shininess = sum / static_cast<double>(fit.points_used);
  fit.residual = rms_residual(fit, points);
  return fit;
}

// ---- least squares

// For a given n the model is linear in k_d and k_s: the best of both, neither negative.
PhongFit best_for(double shininess, std::span<const ReflectancePoint> points) {
  double n = 0.0, s = 0.0, ss = 0.0, r = 0.0, sr = 0.0;
  for (const ReflectancePoint& p : points) {
    const double basis = lobe(p.angle_deg, shininess);
    n += 1.0;
    s += basis;
    ss += basis * basis;
    r += p.reflectance;
    sr += basis * p.reflectance;
  }
  PhongFit fit;
  fit.shininess = shininess;
  fit.points_used = points.size();
  const double determinant = n * ss - s * s;
  if (determinant > 1e-14 * n * ss) {
    fit.specular = (n * sr - s * r) / determinant;
    fit.diffuse = (r - fit.specular * s) / n;
  }
  if (fit.specular <= 0.0) {
    fit.specular = 0.0;
    fit.diffuse = r / n;
  } else if (fit.diffuse < 0.0) {
    fit.diffuse = 0.0;
    fit.specular = sr / ss;
  }
  fit.residual = rms_residual(fit, points);
  return fit;
}

// A scan over log n finds the valley, golden section its bottom.
PhongFit least_squares_fit(std::span<const ReflectancePoint> points) {
  constexpr int steps = 400;
  const double low = std::log(least_shininess), high = std::log(most_shininess);
  const auto at = [&](double log_n) { return best_for(std::exp(log_n), points); };
  const auto log_of = [&](int k) { return low + (high - low) * k / steps; };
  int best_step = 0;
  double best = at(low).residual;
  for (int k = 1; k <= steps; ++k) {
    const double residual = at(log_of(k)).residual;
    if (residual < best) {
      best = residual;
      best_step = k;
    }
  }
  const double golden = 0.5 * (std::sqrt(5.0) - 1.0);
  double a = log_of(std::max(0, best_step - 1)), b = log_of(std::min(steps, best_step + 1));
  double c = b - golden * (b - a), d = a + golden * (b - a);
  double at_c = at(c).residual, at_d = at(d).residual;
  while (b - a > 1e-13) {
    if (at_c < at_d) {
      b = d;
      d = c;
      at_d = at_c;
      c = b - golden * (b - a);
      at_c = at(c).residual;
    } else {
      a = c;
      c = d;
      at_c = at_d;
      d = a + golden * (b - a);
      at_d = at(d).residual;
    }
  }
  PhongFit fit = at(0.5 * (a + b));
  if (fit.specular <= 0.0) fit.shininess = 1.0;
  return fit;
}

// ---- reading

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(" \t\r");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

std::optional<double> number_in(std::string_view text) {
  text = trimmed(text);
  if (text.starts_with('+')) text.remove_prefix(1);
  double value = 0.0;
  const auto [stop, problem] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (problem != std::errc() || stop != text.data() + text.size()) return std::nullopt;
  return value;
}

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

std::vector<ReflectancePoint> read_reflectance(const std::filesystem::path& path) {
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) {
    throw Error(Blame::Input, path.string(), "is a folder", {}, "Name a CSV file");
  }
  std::ifstream file(path);
  if (!file) throw Error(Blame::Input, path.string(), "cannot be read: there is no such file");
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
                  fmt::format("\"{}\" does not have two columns", trimmed(row)),
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
  if (file.bad()) throw Error(Blame::Work, path.string(), "cannot be read to its end");
  return points;
}

PhongFits fit_phong(std::span<const ReflectancePoint> points, const std::string& source) {
  const std::size_t angles = curve_of(points).size();
  if (angles < 3) {
    throw Error(Blame::Input, source, fmt::format("has {} different angles", angles),
                "three unknowns need at least 3", "Add measured points");
  }
  PhongFits fits{report_fit(points, source), least_squares_fit(points), {}};
  if (fits.report.specular <= 0.0) {
    fits.notes.emplace_back("no highlight: the reflectance at 0 degrees is not above that at 80");
  } else if (fits.report.points_used == 0) {
    fits.notes.emplace_back(
        "no point between 0 and 80 degrees shows the highlight, so n = 1 in the "
        "report's method says nothing");
  }
  if (fits.least_squares.shininess >= 0.99 * most_shininess) {
    fits.notes.emplace_back(
        "the highlight is narrower than the steps of the angle: n is a lower bound");
  }
  for (const PhongFit& fit : {fits.report, fits.least_squares}) {
    if (reflected_share(fit) <= 1.0) continue;
    fits.notes.emplace_back(
        fmt::format("k_d + 2 k_s / (n + 2) = {:.4g} exceeds 1: a scene refuses such a material",
                    reflected_share(fit)));
  }
  return fits;
}

}  // namespace earthshine::scenes

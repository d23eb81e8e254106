// SPDX-License-Identifier: Apache-2.0
#include "tests/validation/cie_cases.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "scenes/light/ies_file.h"
#include "tests/support/ies_text.h"
#include "tests/support/scene_builder.h"

namespace earthshine::validation {
namespace {

using base::pi;
using radiosity::SolveReport;
using Corners = std::array<Vec3, 4>;  // counter-clockwise seen from the front

const Vec3 up{0, 0, 1}, down{0, 0, -1}, inward_y{0, 1, 0};  // inward from the wall y = 0

// A black square of 2 cm centred on a point.
void receiver(tests::SceneBuilder& builder, std::uint32_t black, const Vec3& point,
              const Vec3& normal) {
  const Vec3 along = 0.01 * Vec3(1, 0, 0);
  const Vec3 across = glm::cross(normal, along);
  builder.quad(black, point - along - across, point + along - across, point + along + across,
               point - along + across);
}

// Illuminance by a polygon of exitance 1 that is unoccluded and in front of the point: sum over its
// edges of angle_k normal . unit(r_k x r_k+1), over 2 pi (Lambert 1760).
double by_polygon(const Vec3& point, const Vec3& normal, const Corners& corners) {
  double sum = 0.0;
  for (std::size_t k = 0; k < corners.size(); ++k) {
    const Vec3 a = glm::normalize(corners[k] - point);
    const Vec3 b = glm::normalize(corners[(k + 1) % corners.size()] - point);
    const Vec3 edge = glm::cross(a, b);
    const double sine = glm::length(edge);
    if (sine > 0.0) sum -= std::atan2(sine, glm::dot(a, b)) * glm::dot(normal, edge) / sine;
  }
  return sum / (2.0 * pi);
}

// Receivers come first: object k is at point k.
double at_receiver(const SolveReport& report, std::size_t point) {
  return report.objects[point].illuminance_lx.g;
}

// "5.2": 1000 cd straight down, falling as the cosine, 3 m above a plane: E = 1000 cos^2 / d^2 =
// 1000 h^2 / d^4.
CieCase point_source() {
  CieCase c{"5.2", "lx", {}, {}, at_receiver};
  tests::SceneBuilder builder;
  const std::uint32_t black = builder.material(tests::grey(0.0));
  constexpr std::array<std::array<double, 3>, 10> points = {{{0, 0, 111.11},
                                                             {.5, 0, 105.21},
                                                             {1, 0, 90.02},
                                                             {1.5, 0, 71.11},
                                                             {.5, .5, 99.73},
                                                             {1, .5, 85.64},
                                                             {1.5, .5, 68.06},
                                                             {1, 1, 74.36},
                                                             {1.5, 1, 59.98},
                                                             {1.5, 1.5, 49.39}}};
  constexpr double h2 = 9.0;
  for (const auto& [x, y, reference] : points) {
    receiver(builder, black, {x, y, 0}, up);
    const double d2 = h2 + x * x + y * y;
    c.points.push_back({fmt::format("({}, {})", x, y), reference, 1000.0 * h2 / (d2 * d2)});
  }
  tests::IesText ies;
  ies.vertical = tests::steps(0, 90, 1);
  ies.candela = [](double theta_deg, double) {
    return 1000.0 * std::max(0.0, std::cos(base::radians(theta_deg)));
  };
  scenes::Lamp lamp;
  lamp.name = lamp.group = "lamp";
  lamp.kind = scenes::LampKind::Measured;
  lamp.position = {0, 0, 3};
  lamp.axis = down;
  lamp.photometry = scenes::parse_ies(ies.text(), "case-5.2.ies").light;
  lamp.intensity_cd = Rgb(lamp.photometry->peak_cd());
  builder.scene.lamps.push_back(lamp);
  c.scene = std::move(builder.scene);
  return c;
}

// Points on a line of the wall y = 0, common to 5.3, 5.6 and 5.7, and on a line of the floor or
// ceiling, with the closed form for the polygon `visible` from each point.
struct Lines {
  std::vector<std::pair<double, double>> wall;   // z, reference
  std::vector<std::pair<double, double>> level;  // y, reference
  double level_z = 0.0;
};
void add_lines(const Lines& lines, double exitance, tests::SceneBuilder& builder,
               const std::function<Corners(const Vec3& point)>& visible, CieCase& c) {
  const std::uint32_t black = builder.material(tests::grey(0.0));
  const auto add = [&](const Vec3& point, const Vec3& normal, std::string where, double reference) {
    receiver(builder, black, point, normal);
    c.points.push_back(
        {std::move(where), reference, exitance * by_polygon(point, normal, visible(point))});
  };
  for (const auto& [z, reference] : lines.wall) {
    add({2, 0, z}, inward_y, fmt::format("wall, z {}", z), reference);
  }
  const bool is_floor = lines.level_z == 0.0;
  for (const auto& [y, reference] : lines.level) {
    add({2, y, lines.level_z}, is_floor ? up : down,
        fmt::format("{}, y {}", is_floor ? "floor" : "ceiling", y), reference);
  }
}

// "5.3": 1 x 1 m of 1000 cd in the middle of the ceiling of a room of 4 x 4 x 3 m. The black walls
// are omitted because they reflect no light.
CieCase area_source() {
  CieCase c{"5.3", "lx", {}, {}, at_receiver};
  tests::SceneBuilder builder;
  constexpr double exitance = 1000.0 * pi;
  const Corners source = {{{1.5, 1.5, 3}, {1.5, 2.5, 3}, {2.5, 2.5, 3}, {2.5, 1.5, 3}}};
  add_lines(
      {{{2.75, 32.68}, {2.25, 75.09}, {1.75, 81.38}, {1.25, 69.12}, {.75, 53.41}, {.25, 39.90}},
       {{.25, 61.27}, {.75, 79.18}, {1.25, 95.52}, {1.75, 105.89}}},
      exitance, builder, [&](const Vec3&) { return source; }, c);
  scenes::Lamp lamp;
  lamp.name = lamp.group = "lamp";
  lamp.kind = scenes::LampKind::Rectangle;
  lamp.position = {2, 2, 3};
  lamp.axis = down;
  lamp.edge_u = {0, 1, 0};
  lamp.edge_v = {1, 0, 0};
  lamp.exitance = Rgb(exitance);
  builder.scene.lamps.push_back(lamp);
  c.scene = std::move(builder.scene);
  return c;
}

// A box of shared walls with fronts inside.
void room(tests::SceneBuilder& builder, const scenes::Material& material, const Vec3& size) {
  const std::uint32_t m = builder.material(material);
  builder.room({m, m, m, m, m, m});
  for (Vec3& p : builder.scene.vertices) p *= size;
}

void isotropic_lamp(tests::SceneBuilder& builder, const Vec3& position, double flux_lm) {
  scenes::Lamp lamp;
  lamp.name = lamp.group = "lamp";
  lamp.position = position;
  lamp.intensity_cd = Rgb(flux_lm / (4.0 * pi));
  builder.scene.lamps.push_back(lamp);
}

double mean_illuminance(const SolveReport& report, int channel) {
  double flux = 0.0, area = 0.0;
  for (const radiosity::ObjectLight& wall : report.objects) {
    flux += wall.area_m2 * wall.illuminance_lx[channel];
    area += wall.area_m2;
  }
  return flux / area;
}

constexpr double flux_lm = 10000.0;

// "5.4": in a closed black room all of 10 000 lm land.
CieCase closed_black_room() {
  CieCase c{"5.4", "lm", {}, {{"all surfaces", flux_lm, flux_lm}}, {}};
  tests::SceneBuilder builder;
  room(builder, tests::grey(0.0), {4, 4, 3});
  isotropic_lamp(builder, {2, 2, 1.5}, flux_lm);
  c.scene = std::move(builder.scene);
  c.found = [](const SolveReport& report, std::size_t) {
    constexpr double area_m2 = 2 * 4 * 4 + 4 * 4 * 3;
    return mean_illuminance(report, 1) * area_m2;
  };
  return c;
}

// "5.6": only a uniformly lit floor of 4 x 4 m emits: E over its exitance, in %.
CieCase lit_floor() {
  CieCase c{"5.6", "%", {}, {}, at_receiver};
  tests::SceneBuilder builder;
  const Corners floor = {{{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}}};
  add_lines(
      {{{.75, 35.901}, {1.25, 27.992}, {1.75, 21.639}, {2.25, 16.716}, {2.75, 12.967}},
       {{.25, 26.80}, {.75, 30.94}, {1.25, 33.98}, {1.75, 35.57}},
       3.0},
      100.0, builder, [&](const Vec3&) { return floor; }, c);
  builder.quad(builder.material(tests::grey(0.3, 100.0)), floor[0], floor[1], floor[2], floor[3]);
  c.scene = std::move(builder.scene);
  return c;
}

// "5.7": a uniformly lit wall of 4 x 3 m at y = 4 and a black obstruction of 4 x 0.2 x 1 m before
// it. From the points, all at x = 2, the wall is visible above the line over the top of the
// obstruction.
CieCase lit_wall_behind_an_obstruction() {
  CieCase c{"5.7", "%", {}, {}, at_receiver};
  tests::SceneBuilder builder;
  constexpr double front = 2.5, back = 2.7, top = 1.0, wall_y = 4.0, wall_z = 3.0;
  const auto above = [](double z) {
    return Corners{{{0, wall_y, z}, {4, wall_y, z}, {4, wall_y, wall_z}, {0, wall_y, wall_z}}};
  };
  const auto visible = [&](const Vec3& point) {
    double z = 0.0;
    for (const double y : {front, back}) {
      z = std::max(z, point.z + (top - point.z) * (wall_y - point.y) / (y - point.y));
    }
    return above(std::min(z, wall_z));
  };
  add_lines(
      {{{2.75, 16.07}, {2.25, 16.33}, {1.75, 15.40}, {1.25, 13.32}, {.75, 10.32}, {.25, 7.08}},
       {{.25, 3.38}, {.75, 3.63}, {1.25, 3.01}, {1.75, 0.0}, {2.25, 0.0}}},
      100.0, builder, visible, c);
  const Corners wall = above(0.0);
  builder.quad(builder.material(tests::grey(0.6, 100.0)), wall[0], wall[1], wall[2], wall[3]);
  const std::uint32_t black = builder.material(tests::grey(0.0));
  builder.quad(black, {0, front, 0}, {4, front, 0}, {4, front, top}, {0, front, top});
  builder.quad(black, {4, back, 0}, {0, back, 0}, {0, back, top}, {4, back, top});
  builder.quad(black, {0, front, top}, {4, front, top}, {4, back, top}, {0, back, top});
  builder.quad(black, {0, back, 0}, {0, front, 0}, {0, front, top}, {0, back, top});
  builder.quad(black, {4, front, 0}, {4, back, 0}, {4, back, top}, {4, front, top});
  c.scene = std::move(builder.scene);
  return c;
}

// "5.8": a closed cube of 4 m with 10 000 lm in its middle: indirect E = flux rho / (S (1 - rho)).
// Colours are independent: each scene tests three reflectances, one per channel.
CieCase cube(const std::array<std::pair<double, double>, 3>& of_channel) {
  constexpr double area_m2 = 6 * 4 * 4;
  CieCase c{"5.8", "lx", {}, {}, {}};
  scenes::Material wall = tests::grey(0.0);
  for (int k = 0; k < 3; ++k) {
    const auto& [rho, reference] = of_channel[std::size_t(k)];
    wall.diffuse[k] = rho;
    c.points.push_back(
        {fmt::format("ρ {}", rho), reference, flux_lm * rho / (area_m2 * (1.0 - rho))});
  }
  tests::SceneBuilder builder;
  room(builder, wall, {4, 4, 4});
  isotropic_lamp(builder, {2, 2, 2}, flux_lm);
  c.scene = std::move(builder.scene);
  c.found = [](const SolveReport& report, std::size_t point) {
    return mean_illuminance(report, static_cast<int>(point)) - flux_lm / area_m2;
  };
  return c;
}

}  // namespace

std::vector<CieCase> cie_cases() {
  return {point_source(),
          area_source(),
          closed_black_room(),
          lit_floor(),
          lit_wall_behind_an_obstruction(),
          cube({{{.05, 5.48}, {.95, 1979.0}, {.1, 11.6}}}),
          cube({{{.2, 26.0}, {.9, 937.0}, {.3, 44.6}}}),
          cube({{{.4, 69.4}, {.8, 417.0}, {.5, 104.0}}}),
          cube({{{.6, 156.0}, {.7, 243.0}, {.6, 156.0}}})};
}

}  // namespace earthshine::validation

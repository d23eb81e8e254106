// SPDX-License-Identifier: Apache-2.0
#include "tests/support/case_scene.h"

#include <cmath>

namespace earthshine::tests {
namespace {

struct Ball {
  std::vector<std::array<Vec3, 3>> triangles;  // on the unit sphere, outward
  double area = 0.0;
};

Ball geodesic(int level) {
  const double g = 0.5 * (1.0 + std::sqrt(5.0));
  const std::array<Vec3, 12> v{Vec3{-1, g, 0}, {1, g, 0}, {-1, -g, 0}, {1, -g, 0},
                               {0, -1, g},     {0, 1, g}, {0, -1, -g}, {0, 1, -g},
                               {g, 0, -1},     {g, 0, 1}, {-g, 0, -1}, {-g, 0, 1}};
  constexpr int faces[20][3] = {{0, 11, 5}, {0, 5, 1},  {0, 1, 7},   {0, 7, 10}, {0, 10, 11},
                                {1, 5, 9},  {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                                {3, 9, 4},  {3, 4, 2},  {3, 2, 6},   {3, 6, 8},  {3, 8, 9},
                                {4, 9, 5},  {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}};
  Ball ball;
  for (const auto& f : faces) {
    ball.triangles.push_back({glm::normalize(v[std::size_t(f[0])]),
                              glm::normalize(v[std::size_t(f[1])]),
                              glm::normalize(v[std::size_t(f[2])])});
  }
  for (int k = 0; k < level; ++k) {
    std::vector<std::array<Vec3, 3>> finer;
    for (const auto& [a, b, c] : ball.triangles) {
      const Vec3 ab = glm::normalize(a + b), bc = glm::normalize(b + c), ca = glm::normalize(c + a);
      finer.insert(finer.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
    }
    ball.triangles = std::move(finer);
  }
  for (const auto& [a, b, c] : ball.triangles) {
    ball.area += 0.5 * glm::length(glm::cross(b - a, c - a));
  }
  return ball;
}

}  // namespace

double same_area_radius(int n, double radius) {
  const double turn = 2.0 * base::pi / n;
  return radius * std::sqrt(turn / std::sin(turn));
}

double same_length_radius(int n, double radius) {
  const double half_turn = base::pi / n;
  return radius * half_turn / std::sin(half_turn);
}

std::uint32_t CaseScene::material(double diffuse, double emit, bool two_sided) {
  scenes::Material m;
  m.name = "grey-" + std::to_string(scene.materials.size());
  m.light_group = "panels";
  m.diffuse = Rgb(diffuse);
  m.emit = Rgb(emit);
  m.two_sided = two_sided;
  scene.materials.push_back(m);
  return static_cast<std::uint32_t>(scene.materials.size() - 1);
}

std::uint32_t CaseScene::mirror() {
  const std::uint32_t m = material(0.0);
  scene.materials[m].mirror = Rgb(1.0);
  return m;
}

std::size_t CaseScene::object(const std::string& name, std::uint32_t material) {
  scenes::Object record;
  record.name = name;
  record.first_triangle = static_cast<std::uint32_t>(scene.triangles.size());
  scene.objects.push_back(record);
  material_ = material;
  return scene.objects.size() - 1;
}

std::uint32_t CaseScene::vertex(const Vec3& p) {
  scene.vertices.push_back(p);
  return static_cast<std::uint32_t>(scene.vertices.size() - 1);
}

void CaseScene::add(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
  const auto object = static_cast<std::uint32_t>(scene.objects.size() - 1);
  scene.triangles.push_back({{a, b, c}, object, material_, polygon_});
  ++scene.objects.back().triangle_count;
}

void CaseScene::triangle(const Vec3& a, const Vec3& b, const Vec3& c) {
  const std::uint32_t v = vertex(a);
  vertex(b);
  vertex(c);
  add(v, v + 1, v + 2);
  ++polygon_;
}

void CaseScene::quad(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const std::uint32_t v = vertex(a);
  vertex(b);
  vertex(c);
  vertex(d);
  add(v, v + 1, v + 2);
  add(v, v + 2, v + 3);
  ++polygon_;
}

void CaseScene::grid(const Vec3& corner, const Vec3& u, const Vec3& v, int rows, int columns) {
  const auto at = [&](int i, int j) {
    return corner + (double(i) / rows) * u + (double(j) / columns) * v;
  };
  for (int i = 0; i < rows; ++i) {
    for (int j = 0; j < columns; ++j) {
      quad(at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
    }
  }
}

void CaseScene::level(double x0, double x1, double y0, double y1, double z, bool up, int rows,
                      int columns) {
  const Vec3 u(x1 - x0, 0, 0), v(0, y1 - y0, 0);
  if (up) {
    grid({x0, y0, z}, u, v, rows, columns);
  } else {
    grid({x0, y0, z}, v, u, columns, rows);
  }
}

void CaseScene::ring(int n, double r0, double z0, double r1, double z1, bool flip) {
  const auto at = [n](double r, double z, int k) {
    const double angle = 2.0 * base::pi * (k % n) / n;
    return Vec3(r * std::cos(angle), r * std::sin(angle), z);
  };
  for (int k = 0; k < n; ++k) {
    std::array<Vec3, 4> c{at(r0, z0, k), at(r1, z1, k), at(r1, z1, k + 1), at(r0, z0, k + 1)};
    if (flip) std::swap(c[1], c[3]);
    if (r0 <= 0.0) {
      triangle(c[0], flip ? c[2] : c[1], flip ? c[3] : c[2]);
    } else if (r1 <= 0.0) {
      triangle(c[0], c[1], flip ? c[2] : c[3]);
    } else {
      quad(c[0], c[1], c[2], c[3]);
    }
  }
}

void CaseScene::sphere(const Vec3& centre, double radius, int level, bool inward) {
  const Ball ball = geodesic(level);
  const double r = radius * std::sqrt(4.0 * base::pi / ball.area);
  for (const auto& [a, b, c] : ball.triangles) {
    triangle(centre + r * a, centre + r * (inward ? c : b), centre + r * (inward ? b : c));
  }
}

}  // namespace earthshine::tests

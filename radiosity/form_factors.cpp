// SPDX-License-Identifier: Apache-2.0
#include "radiosity/form_factors.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "base/parallel.h"
#include "base/random.h"
#include "scenes/specular.h"

namespace earthshine::radiosity {
namespace {

using scenes::HitPacket;
using scenes::RayPacket;

constexpr int most_specular_steps = 16;

struct Row {
  std::vector<std::uint32_t> column;
  std::vector<float> hits;
  double black = 0.0, sky = 0.0;  // in rays
  Rgb sky_illuminance{0.0};
  std::uint64_t rays = 0;
};

// Per thread: a dense counter that is cleared through the list of touched columns.
struct Counter {
  std::vector<float> count;
  std::vector<std::uint32_t> touched;

  explicit Counter(std::size_t patches) : count(patches, 0.0F) {}

  void add(std::uint32_t patch, float weight) {
    if (count[patch] == 0.0F) touched.push_back(patch);
    count[patch] += weight;
  }
  void take(Row& row) {
    std::sort(touched.begin(), touched.end());
    row.column = touched;
    row.hits.reserve(touched.size());
    for (const std::uint32_t patch : touched) {
      row.hits.push_back(count[patch]);
      count[patch] = 0.0F;
    }
    touched.clear();
  }
};

class Caster {
 public:
  Caster(const scenes::Scene& scene, const scenes::RayQuery& query, const Patches& patches,
         const std::vector<double>& kept, const FormFactorOptions& options, int rays,
         const SkyRadiance& sky)
      : scene_(scene),
        query_(query),
        patches_(patches),
        kept_(kept),
        sky_(sky),
        seed_(options.seed),
        rays_(static_cast<std::uint32_t>(rays)) {}

  Row cast(std::uint32_t patch, Counter& counter) const {
    Row row;
    const base::SobolOwen4 sobol(base::Key(seed_, base::Stream::FormFactor, patch));
    const base::Frame3 frame = base::frame_around(patches_.normal(patch));
    const Vec3 lift = frame.normal * query_.surface_offset_m();
    RayPacket packet;
    HitPacket hits;
    Vec3 origins[RayPacket::width], directions[RayPacket::width];
    for (std::uint32_t first = 0; first < rays_; first += RayPacket::width) {
      const std::uint32_t count = std::min<std::uint32_t>(RayPacket::width, rays_ - first);
      for (std::uint32_t k = 0; k < count; ++k) {
        const auto p = sobol.point(first + k);
        const float r = std::sqrt(p[0]), phi = 2.0F * static_cast<float>(base::pi) * p[1];
        directions[k] =
            frame.to_world({r * std::cos(phi), r * std::sin(phi), std::sqrt(1.0F - p[0])});
        origins[k] = patches_.point(patch, inset(p[2]), inset(p[3])) + lift;
        query_.set(packet, k, origins[k], directions[k]);
      }
      query_.closest(packet, count, hits);
      row.rays += count;
      for (std::uint32_t k = 0; k < count; ++k) {
        const scenes::Hit hit{hits.triangle[k], hits.u[k], hits.v[k], hits.t[k],
                              hits.front[k] != 0};
        follow(origins[k], directions[k], hit, row, counter);
      }
    }
    counter.take(row);
    row.sky_illuminance *= base::pi / rays_;
    return row;
  }

 private:
  // Keeps sample points off the patch's edges, where rounding could put them behind a neighbour.
  static double inset(float x) { return 1e-4 + (1.0 - 2e-4) * x; }

  // Counts the hit and, where a mirror or glass is met, the hits behind it.
  void follow(Vec3 origin, Vec3 direction, scenes::Hit hit, Row& row, Counter& counter) const {
    float weight = 1.0F;
    for (int step = 0;; ++step) {
      if (hit.missed()) {
        row.sky += weight;
        if (sky_) row.sky_illuminance += double(weight) * sky_(direction);
        return;
      }
      const std::uint32_t to = patches_.find(hit.triangle, hit.u, hit.v, hit.front);
      const scenes::Material& material = scene_.materials[scene_.triangles[hit.triangle].material];
      const bool glass = base::max_component(material.transmit) > 0.0;
      if (to == no_patch && !glass) {
        row.black += weight;
        return;
      }
      // The inside of a glass body passes light on as its outside does, and is no patch of its own.
      const double passed_on = to == no_patch ? 1.0 : 1.0 - kept_[to];
      if (to != no_patch) counter.add(to, weight);
      weight *= static_cast<float>(passed_on);
      if (weight <= 0.0F) return;
      if (step == most_specular_steps) {
        row.black += weight;
        return;
      }
      const Vec3 normal = scenes::triangle_normal(scene_, hit.triangle);
      const Vec3 at = origin + hit.t * direction;
      direction = scenes::specular_direction(material, normal, direction);
      const double side = glm::dot(direction, normal) > 0.0 ? 1.0 : -1.0;
      origin = at + normal * (side * query_.surface_offset_m());
      hit = query_.closest(origin, direction);
      ++row.rays;
    }
  }

  const scenes::Scene& scene_;
  const scenes::RayQuery& query_;
  const Patches& patches_;
  const std::vector<double>& kept_;
  const SkyRadiance& sky_;
  std::uint64_t seed_;
  std::uint32_t rays_;
};

// a = 1 - mirror - transmit, as luminance: one matrix serves the three channels.
std::vector<double> kept_shares(const scenes::Scene& scene, const Patches& patches) {
  std::vector<double> kept(patches.count());
  for (std::size_t i = 0; i < kept.size(); ++i) {
    const scenes::Material& m = scene.materials[patches.material(static_cast<std::uint32_t>(i))];
    kept[i] = m.passes_light_on()
                  ? std::clamp(1.0 - base::luminance(m.mirror + m.transmit), 0.0, 1.0)
                  : 1.0;
  }
  return kept;
}

void assemble(std::vector<Row>& rows, FormFactors& factors) {
  const std::size_t count = rows.size();
  factors.row_start.assign(count + 1, 0);
  for (std::size_t i = 0; i < count; ++i) {
    factors.row_start[i + 1] = factors.row_start[i] + rows[i].column.size();
    factors.ray_count += rows[i].rays;
  }
  factors.column.resize(factors.row_start[count]);
  factors.hits.resize(factors.row_start[count]);
  for (std::size_t i = 0; i < count; ++i) {
    const auto start = static_cast<std::ptrdiff_t>(factors.row_start[i]);
    std::copy(rows[i].column.begin(), rows[i].column.end(), factors.column.begin() + start);
    std::copy(rows[i].hits.begin(), rows[i].hits.end(), factors.hits.begin() + start);
    factors.sky_illuminance[i] = rows[i].sky_illuminance;
    rows[i] = Row{std::vector<std::uint32_t>(),
                  std::vector<float>(),
                  rows[i].black,
                  rows[i].sky,
                  Rgb(0.0),
                  0};
  }
}

// The shares of sky and black backs, and the row scale that makes the row close to the last digit.
void close_row(FormFactors& factors, std::size_t i, double sky_rays, double black_rays) {
  double landed = 0.0;  // rays that end on patches, mirrors' shares left out
  for (std::uint64_t e = factors.row_start[i]; e < factors.row_start[i + 1]; ++e) {
    landed += double(factors.hits[e]) * factors.kept[factors.column[e]];
  }
  // Equal to the number of rays but for the rounding of mirrors' weights.
  const double all = landed + sky_rays + black_rays;
  factors.row_scale[i] = 1.0 / all;
  factors.sky[i] = factors.escape[i] = sky_rays / all;
  factors.black[i] = factors.lost[i] = black_rays / all;
}

}  // namespace

FormFactors cast_form_factors(const scenes::Scene& scene, const scenes::RayQuery& query,
                              const Patches& patches, const FormFactorOptions& options,
                              const SkyRadiance& sky) {
  const std::size_t count = patches.count();
  FormFactors factors;
  factors.rays_per_patch = static_cast<int>(
      std::bit_ceil(static_cast<std::uint32_t>(std::max(1, options.rays_per_patch))));
  factors.kept = kept_shares(scene, patches);
  factors.sky.assign(count, 0.0);
  factors.black.assign(count, 0.0);
  factors.escape.assign(count, 0.0);
  factors.lost.assign(count, 0.0);
  factors.row_scale.assign(count, 0.0);
  factors.column_scale.assign(count, 1.0);
  factors.sky_illuminance.assign(count, Rgb(0.0));

  std::vector<Row> rows(count);
  const Caster caster(scene, query, patches, factors.kept, options, factors.rays_per_patch, sky);
  base::parallel_chunks(count, 64, [&](std::size_t begin, std::size_t end) {
    thread_local Counter counter(0);
    if (counter.count.size() < count) counter = Counter(count);
    for (std::size_t i = begin; i < end; ++i) {
      rows[i] = caster.cast(static_cast<std::uint32_t>(i), counter);
    }
  });
  assemble(rows, factors);
  for (std::size_t i = 0; i < count; ++i) close_row(factors, i, rows[i].sky, rows[i].black);
  return factors;
}

void multiply(const FormFactors& factors, std::span<const double> x, std::span<double> y,
              std::size_t columns) {
  base::parallel_chunks(factors.count(), 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      double* out = &y[i * columns];
      std::fill(out, out + columns, 0.0);
      for (std::uint64_t e = factors.row_start[i]; e < factors.row_start[i + 1]; ++e) {
        const std::uint32_t j = factors.column[e];
        const double weight = double(factors.hits[e]) * factors.column_scale[j];
        const double* in = &x[j * columns];
        for (std::size_t c = 0; c < columns; ++c) out[c] += weight * in[c];
      }
      for (std::size_t c = 0; c < columns; ++c) out[c] *= factors.row_scale[i];
    }
  });
}

}  // namespace earthshine::radiosity

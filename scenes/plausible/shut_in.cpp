// SPDX-License-Identifier: Apache-2.0
#include "scenes/plausible/shut_in.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>

#include "base/numbers/random.h"
#include "scenes/light/lamp_light.h"
#include "scenes/plausible/views.h"
#include "scenes/reflect/brdf.h"
#include "scenes/text/message_text.h"
#include "scenes/triangle_point.h"

namespace earthshine::scenes {
namespace {

constexpr std::uint32_t most_rays = 512, fewest_rays = 64, rays_of_all = 1U << 16U;
constexpr double nearly_all = 0.95, some = 0.1;
constexpr int most_reflections = 6;

using Emit = std::function<EmittedRay(const std::array<float, 4>& at)>;

class Tracer {
 public:
  Tracer(const Scene& scene, const RayQuery& query, const std::vector<const Camera*>& cameras)
      : scene_(scene), query_(query), cameras_(cameras) {}

  // `what` names the light in the message. Empty result: the light is useful.
  [[nodiscard]] std::string judge(const std::string& what, std::uint32_t rays, std::uint64_t number,
                                  const Emit& emit) const {
    const base::SobolOwen4 points(base::Key(0, base::Stream::ShutInLight, number));
    double all = 0.0, backs = 0.0, fronts = 0.0;
    std::map<std::uint32_t, double> backs_of;  // by object
    for (std::uint32_t k = 0; k < rays; ++k) {
      const EmittedRay ray = emit(points.point(k));
      if (!(ray.weight > 0.0)) continue;
      all += ray.weight;
      const Hit hit = follow(ray.origin, ray.direction);
      if (hit.missed()) continue;
      if (is_black_back(hit)) {
        backs += ray.weight;
        backs_of[scene_.triangles[hit.triangle].object] += ray.weight;
      } else {
        fronts += ray.weight;
      }
    }
    if (!(backs >= some * all) || !(all > 0.0)) return {};
    const bool all_lost = backs > nearly_all * all;
    if (!all_lost && fronts > 0.0 && (cameras_.empty() || comes_into_sight(rays, points, emit))) {
      return {};
    }
    const auto most =
        std::max_element(backs_of.begin(), backs_of.end(),
                         [](const auto& a, const auto& b) { return a.second < b.second; });
    const double share = most->second / all;
    return fmt::format(
        "{} light of {} ends on the black back of the object {}{}; turn the faces of that object "
        "to the light (inward), make them two-sided (orient = \"two-sided\"), or move the light",
        share > 0.995 ? std::string("all") : fmt::format("{:.0f} % of the", 100.0 * share), what,
        in_quotes(scene_.objects[most->first].name),
        all_lost                            ? ""
        : cameras_.empty() || fronts <= 0.0 ? ", and none falls on a front"
                                            : ", and none comes to a place that a camera sees");
  }

 private:
  [[nodiscard]] const Material& material_at(const Hit& hit) const {
    return scene_.materials[scene_.triangles[hit.triangle].material];
  }
  [[nodiscard]] bool is_black_back(const Hit& hit) const {
    return !hit.front && material_at(hit).has_black_back();
  }

  // The first hit on a surface other than glass.
  [[nodiscard]] Hit follow(Vec3 origin, const Vec3& direction) const {
    Hit hit = query_.closest(origin, direction);
    for (int panes = 0; panes < most_panes_passed && !hit.missed(); ++panes) {
      if (!(base::max_component(material_at(hit).transmit) > 0.0)) return hit;
      origin = leave_toward(scene_, query_, hit, direction);
      hit = query_.closest(origin, direction);
    }
    return hit;
  }

  [[nodiscard]] bool a_camera_sees(const Vec3& point) const {
    RayPacket rays;
    const std::uint32_t no_mirrors[RayPacket::width] = {no_mirror, no_mirror, no_mirror, no_mirror,
                                                        no_mirror, no_mirror, no_mirror, no_mirror};
    for (const Camera* camera : cameras_) {
      const Vec3 offset = camera->position - point;
      const double distance = glm::length(offset);
      if (!(distance > 0.0)) return true;
      query_.set(rays, 0, point, offset / distance, distance);
      Rgb share(0.0);
      query_.light_shares(rays, no_mirrors, 1, &share);
      if (base::max_component(share) > 0.0) return true;
    }
    return false;
  }

  // Whether any path from the source, diffuse at every front, has a vertex that a camera sees.
  [[nodiscard]] bool comes_into_sight(std::uint32_t rays, const base::SobolOwen4& points,
                                      const Emit& emit) const {
    for (std::uint32_t k = 0; k < rays; ++k) {
      const EmittedRay ray = emit(points.point(k));
      if (!(ray.weight > 0.0)) continue;
      if (k % 32 == 0 && a_camera_sees(ray.origin)) return true;
      Vec3 origin = ray.origin, direction = ray.direction;
      for (int n = 0; n < most_reflections; ++n) {
        const Hit hit = follow(origin, direction);
        if (hit.missed() || is_black_back(hit)) break;
        const Vec3 normal = (hit.front ? 1.0 : -1.0) * triangle_normal(scene_, hit.triangle);
        origin = leave_toward(scene_, query_, hit, normal);
        if (a_camera_sees(origin)) return true;
        const auto at = points.point(rays * static_cast<std::uint32_t>(n + 1) + k);
        direction = cosine_direction(base::frame_around(normal), at[2], at[3]);
      }
    }
    return false;
  }

  const Scene& scene_;
  const RayQuery& query_;
  const std::vector<const Camera*>& cameras_;
};

// The emitting triangles of an object, sampled by flux.
class EmittingObject {
 public:
  EmittingObject(const Scene& scene, const RayQuery& query, const Object& object)
      : scene_(scene), query_(query) {
    double flux = 0.0;
    for (std::uint32_t k = 0; k < object.triangle_count; ++k) {
      const std::uint32_t t = object.first_triangle + k;
      const Material& material = scene.materials[scene.triangles[t].material];
      if (!material.emits()) continue;
      flux += base::max_component(material.emit) * triangle_area(scene, t);
      triangles_.push_back(t);
      cumulative_.push_back(flux);
    }
  }
  [[nodiscard]] bool empty() const { return triangles_.empty(); }

  [[nodiscard]] EmittedRay emit(const std::array<float, 4>& at) const {
    const double wanted = double(at[0]) * cumulative_.back();
    const auto found = std::upper_bound(cumulative_.begin(), cumulative_.end(), wanted);
    const auto k =
        std::min(static_cast<std::size_t>(found - cumulative_.begin()), triangles_.size() - 1);
    const double below = k == 0 ? 0.0 : cumulative_[k - 1];
    // The rest of the first random number is uniform again: it selects the side of a sheet, and a
    // place.
    double u = std::min((wanted - below) / (cumulative_[k] - below), 1.0);
    const std::uint32_t t = triangles_[k];
    Vec3 normal = triangle_normal(scene_, t);
    if (scene_.materials[scene_.triangles[t].material].two_sided) {
      u *= 2.0;
      if (u >= 1.0) {
        u -= 1.0;
        normal = -normal;
      }
    }
    const auto [a, b, c] = corners_of(scene_, t);
    const double root = std::sqrt(u);
    const Vec3 place = (1.0 - root) * a + root * (1.0 - at[1]) * b + root * at[1] * c;
    return {place + query_.offset_m(t) * normal,
            cosine_direction(base::frame_around(normal), at[2], at[3]), 1.0};
  }

 private:
  const Scene& scene_;
  const RayQuery& query_;
  std::vector<std::uint32_t> triangles_;
  std::vector<double> cumulative_;
};

bool is_lit(const Lamp& lamp) { return base::max_component(lamp_flux_lm(lamp)) > 0.0; }

}  // namespace

std::vector<std::string> shut_in_lights(const Scene& scene, const RayQuery& query,
                                        const std::vector<const Camera*>& cameras) {
  if (scene.triangles.empty()) return {};
  std::vector<std::pair<std::string, EmittingObject>> emitters;
  for (const Object& object : scene.objects) {
    EmittingObject emitter(scene, query, object);
    if (emitter.empty()) continue;
    emitters.emplace_back("the emitting object " + in_quotes(object.name), std::move(emitter));
  }
  const auto lit =
      static_cast<std::size_t>(std::count_if(scene.lamps.begin(), scene.lamps.end(), is_lit));
  const std::size_t sources = std::max<std::size_t>(1, lit + emitters.size());
  const auto rays = static_cast<std::uint32_t>(
      std::clamp<std::size_t>(rays_of_all / sources, fewest_rays, most_rays));
  const Tracer tracer(scene, query, cameras);
  std::vector<std::string> found;
  const auto judge = [&](const std::string& what, std::uint64_t number, const Emit& emit) {
    std::string text = tracer.judge(what, rays, number, emit);
    if (!text.empty()) found.push_back(std::move(text));
  };
  for (std::size_t k = 0; k < scene.lamps.size(); ++k) {
    const Lamp& lamp = scene.lamps[k];
    if (lamp.is_distant() || !is_lit(lamp)) continue;
    judge("lamp " + in_quotes(lamp.name), k, [&lamp](const std::array<float, 4>& at) {
      return emit_from_lamp(lamp, at[0], at[1], at[2], at[3]);
    });
  }
  for (std::size_t k = 0; k < emitters.size(); ++k) {
    judge(emitters[k].first, scene.lamps.size() + k,
          [&](const std::array<float, 4>& at) { return emitters[k].second.emit(at); });
  }
  return found;
}

}  // namespace earthshine::scenes

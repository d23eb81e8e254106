// SPDX-License-Identifier: Apache-2.0
#include "raytrace/adaptive/sample_plan.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <functional>
#include <iterator>

#include "base/parallel.h"
#include "raytrace/tuning.h"

namespace earthshine::raytrace {
namespace {

constexpr auto camera_kind = static_cast<std::uint8_t>(gathered_kinds);
constexpr int bisections = 24;
constexpr double greatest_price = 1e6;      // squared error per ray
constexpr std::size_t sample_classes = 33;  // of pixels, by powers of two of their samples
constexpr std::size_t items_at_once = 4096;

std::size_t class_of(std::uint32_t samples) {
  return static_cast<std::size_t>(std::bit_width(samples));
}

// Expected square of the share f of a pixel beyond an edge that all n samples miss. An edge is in
// the pixel with probability 1/2, at a uniform position: the integral of f^2 (1 - f)^n / 2.
double share_missed(double n) { return 1.0 / ((n + 1.0) * (n + 2.0) * (n + 3.0)); }

// Scatter of the samples of some pixels: squared errors of their means as stated, and for
// independent samples.
struct Scatter {
  std::size_t pixels = 0;
  double found = 0.0, independent = 0.0;
  void add(double squared_error, double variance_of_mean) {
    ++pixels;
    found += squared_error;
    independent += variance_of_mean;
  }
  [[nodiscard]] double share() const {
    return independent > 0.0 ? std::min(1.0, found / independent) : 1.0;
  }
};

}  // namespace

SampleCosts sample_costs(const GatherField* field) {
  SampleCosts costs;
  costs.camera = tuning::camera_cost;
  costs.camera_ray = tuning::ray_cost;
  if (field == nullptr) return costs;
  for (const Gathered kind : {Gathered::Residual, Gathered::Lobe}) {
    double cast = 0.0;
    for (std::size_t p = 0; field->gathers(kind) && p < field->points().size(); ++p) {
      cast += double(field->samples(kind, p));
    }
    const auto total = static_cast<double>(field->rays_of(kind).total());
    costs.field[static_cast<std::size_t>(kind)] =
        tuning::path_ray_cost * (1.0 + total / std::max(1.0, cast));
  }
  return costs;
}

double spent(const PixelSums& sums, const GatherField* field, const SampleCosts& costs) {
  double cost = 0.0;
  for (std::size_t p = 0; p < sums.samples.size(); ++p) {
    cost += costs.camera * sums.samples[p] + costs.camera_ray * double(sums.rays[p]);
  }
  for (std::size_t k = 0; k < gathered_kinds && field != nullptr; ++k) {
    const auto kind = static_cast<Gathered>(k);
    for (std::size_t p = 0; field->gathers(kind) && p < field->points().size(); ++p) {
      cost += costs.field[k] * double(field->samples(kind, p));
    }
  }
  return cost;
}

SamplePlanner::SamplePlanner(const PixelSums& sums, const GatherField* field,
                             const SampleCosts& costs)
    : sums_(sums),
      field_(field),
      costs_(costs),
      stated_(state_error(sums, field)),
      whole_(add_up(stated_)) {}

void SamplePlanner::demand(ErrorDemand demand) {
  for (std::size_t p = 0; p < stated_.squared.size(); ++p) {
    for (std::size_t part = 0; part < error_parts; ++part) {
      stated_.squared[p][part] *= demand.at(part, p);
    }
  }
  whole_ = add_up(stated_);
  demand_ = std::move(demand);
}

void SamplePlanner::find_gains() {
  if (has_gains_ || whole_.reference_luminance <= 0.0) return;
  has_gains_ = true;
  const double scale = 1.0 / (static_cast<double>(whole_.pixels) * whole_.reference_luminance *
                              whole_.reference_luminance);
  std::size_t items = stated_.luminance.size();
  for (const Gathered kind : {Gathered::Solution, Gathered::Residual, Gathered::Lobe}) {
    if (field_ != nullptr && field_->gathers(kind)) items += field_->points().size();
  }
  gains_ = std::make_unique_for_overwrite<Gain[]>(items);
  if (field_ != nullptr) find_field_gains(scale);
  find_pixel_gains(scale);
}

template <class Fill>
void SamplePlanner::append_gains(std::size_t count, const Fill& fill) {
  Gain* const gains = &gains_[gain_count_];
  gain_count_ += count;
  base::parallel_chunks(count, items_at_once, [&](std::size_t begin, std::size_t end) {
    fill(begin, end, gains + begin);
    for (std::size_t k = begin; k < end; ++k) gains[k].find_prices();
  });
}

// For isolated points the likely noise directs the samples (variance_prior). The plan expects no
// more reduction than their own stated error confirms.
void SamplePlanner::find_field_gains(double scale) {
  const Window& window = sums_.window;
  const double pixels = field_->step() * field_->step();  // that read a point
  for (std::size_t k = 0; k < gathered_kinds; ++k) {
    const auto kind = static_cast<Gathered>(k);
    if (!field_->gathers(kind)) continue;
    const Shared& shared = field_->shared(kind);
    const auto fewest = static_cast<float>(GatherField::fewest_samples(kind));
    const auto gain_of = [&](std::size_t p, double one, double two, double four) -> Gain {
      const auto [x, y] = field_->picture_pixel(p);
      if (!window.contains(x, y)) return {};
      const double reflected = field_->reflected(kind, p);
      if (reflected <= 0.0) return {};
      // Points without own samples start with the fewest.
      const float samples = std::max(field_->samples(kind, p), fewest);
      const double weight =
          stated_.weight(window.index(x, y), whole_.luminance) * reflected * field_->cover_of(p);
      const double asked = demand_ ? double(demand_->at(k, window.index(x, y))) : 1.0;
      const double factor = asked * weight * weight * scale * pixels;
      if (factor * (one - four) <= 0.0) return {};
      return {static_cast<std::uint32_t>(p),
              static_cast<std::uint8_t>(k),
              samples,
              static_cast<float>(double(samples) * costs_.field[k]),
              static_cast<float>(factor * (one - two)),
              static_cast<float>(factor * (two - four)),
              static_cast<float>(double(shared.squared_error[p]) / one),
              Gain::none,
              Gain::none};
    };
    append_gains(field_->points().size(), [&](std::size_t begin, std::size_t end, Gain* gain) {
      std::array<float, items_at_once> two, four;
      shared.squared_errors_with(2.0, begin, end, two.data());
      shared.squared_errors_with(4.0, begin, end, four.data());
      for (std::size_t at = 0; at < end - begin; ++at) {
        const double more = double(shared.variance_prior[begin + at]);
        gain[at] = gain_of(begin + at, double(shared.squared_error[begin + at]) + more,
                           double(two[at]) + more / 2.0, double(four[at]) + more / 4.0);
      }
    });
  }
}

// The variance of a pixel is the largest of three estimates. Its own samples give the first. The
// noisiest neighbour gives the second, because few samples may miss what covers less than 1/n of
// the pixel. The contrast to the neighbours gives the third, as if all samples missed an edge. The
// half differences of pixels with equal sample counts give the variance reduction by stratified
// samples.
void SamplePlanner::find_pixel_gains(double scale) {
  const Window& window = sums_.window;
  std::vector<double> variance(stated_.luminance.size());  // of one sample, weighted
  std::vector<double> mean(variance.size());
  std::array<Scatter, sample_classes> of_class{};
  Scatter all;
  for (std::size_t p = 0; p < variance.size(); ++p) {
    const double weight = stated_.weight(p, whole_.luminance);
    const double of_mean = weight * weight * sums_.sample_variance(p);
    variance[p] = of_mean * sums_.samples[p];
    mean[p] = sums_.luminance[p] / std::max(1U, sums_.samples[p]);
    const double found = weight * weight * sums_.squared_error(p);
    all.add(found, of_mean);
    of_class[class_of(sums_.samples[p])].add(found, of_mean);
  }
  const auto gain_of = [&](std::size_t p) -> Gain {
    const auto columns = static_cast<std::size_t>(window.columns);
    const int x = window.x + static_cast<int>(p % columns);
    const int y = window.y + static_cast<int>(p / columns);
    double around = 0.0, contrast = 0.0;
    for (int qy = std::max(window.y, y - 1); qy <= std::min(window.y + window.rows - 1, y + 1);
         ++qy) {
      for (int qx = std::max(window.x, x - 1); qx <= std::min(window.x + window.columns - 1, x + 1);
           ++qx) {
        const std::size_t q = window.index(qx, qy);
        around = std::max(around, variance[q]);
        contrast = std::max(contrast, std::abs(mean[q] - mean[p]));
      }
    }
    const double samples = std::max(1U, sums_.samples[p]);
    const double weight = stated_.weight(p, whole_.luminance);
    const double unseen = weight * weight * contrast * contrast * share_missed(samples);
    const double likely = std::max(
        {variance[p], around * std::min(1.0, tuning::unsure_samples / samples), unseen * samples});
    const Scatter& like = of_class[class_of(sums_.samples[p])];
    const double better = (like.pixels < tuning::few_pixels_of_class ? all : like).share();
    const double asked = demand_ ? double(demand_->at(camera_kind, p)) : 1.0;
    const double error = asked * likely * better * scale / samples;
    if (error <= 0.0) return {};
    const double cost = samples * costs_.camera + double(sums_.rays[p]) * costs_.camera_ray;
    return {static_cast<std::uint32_t>(p),
            camera_kind,
            static_cast<float>(samples),
            static_cast<float>(cost),
            static_cast<float>(error / 2.0),
            static_cast<float>(error / 4.0),
            static_cast<float>(variance[p] / likely),
            Gain::none,
            Gain::none};
  };
  append_gains(variance.size(), [&](std::size_t begin, std::size_t end, Gain* gain) {
    for (std::size_t p = begin; p < end; ++p) *gain++ = gain_of(p);
  });
}

void SamplePlanner::Gain::find_prices() {
  price_of_two = price_of_four = none;
  if (cost <= 0.0F) return;
  price_of_two = first / cost;
  price_of_four = std::max(second / (2.0F * cost), (first + second) / (3.0F * cost));
}

SamplePlanner::Outcome SamplePlanner::outcome(std::span<const Gain> gains, double per_cost) const {
  const auto price = static_cast<float>(per_cost);
  const Outcome change = base::ordered_sum(
      gains.size(), items_at_once, Outcome(), [&](std::size_t begin, std::size_t end) {
        Outcome sum;
        for (std::size_t k = begin; k < end; ++k) {
          const Gain& gain = gains[k];
          const int times = gain.factor(price);
          if (times == 1) continue;
          sum.squared_error -=
              double(gain.found) * (double(gain.first) + (times == 4 ? double(gain.second) : 0.0));
          sum.cost += (times - 1) * double(gain.cost);
        }
        return sum;
      });
  return {squared_error() + change.squared_error, change.cost};
}

SamplePlan SamplePlanner::no_samples() const {
  SamplePlan plan;
  plan.squared_error = squared_error();
  for (std::size_t k = 0; k < gathered_kinds && field_ != nullptr; ++k) {
    plan.field[k].assign(field_->points().size(), 0U);
  }
  plan.camera = sums_.samples;
  return plan;
}

SamplePlan SamplePlanner::plan_for_specks(double most_cost) const {
  struct Speck {
    std::size_t pixel;
    double squared_error, visibility;  // of that, relative to the pixel's luminance, squared
  };
  std::vector<Speck> specks;
  const double floor = tuning::dimmest_share * whole_.reference_luminance;
  for (std::size_t p = 0; p < stated_.luminance.size() && floor > 0.0; ++p) {
    if (stated_.shows[p] == Shows::Nothing) continue;
    double square = 0.0;
    for (const float part : stated_.squared[p]) square += double(part);
    const double shown = double(stated_.luminance[p]) + double(stated_.source[p]);
    const double against = std::max(shown, floor);
    const double visibility = square / (against * against);
    if (visibility > tuning::visible_deviation * tuning::visible_deviation) {
      specks.push_back({p, square, visibility});
    }
  }
  std::ranges::stable_sort(specks, std::greater(), &Speck::visibility);
  SamplePlan plan = no_samples();
  for (const Speck& speck : specks) {
    if (plan.cost > most_cost) break;
    for (std::size_t k = 0; k < gathered_kinds && field_ != nullptr; ++k) {
      const auto kind = static_cast<Gathered>(k);
      if (double(stated_.squared[speck.pixel][k]) < speck.squared_error / 8.0) continue;
      for (const FieldTerm& term : sums_.terms[speck.pixel]) {
        std::uint32_t& more = plan.field[k][term.point];
        if (more > 0 || field_->reflected(kind, term.point) <= 0.0) continue;
        more = 4U * std::max(GatherField::fewest_samples(kind),
                             static_cast<std::uint32_t>(field_->samples(kind, term.point)));
        plan.field_cost += costs_.field[k] * more;
        plan.cost += costs_.field[k] * more;
      }
    }
    const double camera = stated_.squared[speck.pixel][static_cast<std::size_t>(ErrorPart::Camera)];
    if (camera < speck.squared_error / 8.0) continue;
    plan.camera[speck.pixel] *= 4U;
    plan.cost += 3.0 * (costs_.camera * sums_.samples[speck.pixel] +
                        costs_.camera_ray * double(sums_.rays[speck.pixel]));
  }
  return plan;
}

SamplePlan SamplePlanner::plan(double wanted, double most_cost) {
  find_gains();
  const double now = squared_error();
  SamplePlan plan = no_samples();
  // Bisection for the price of a ray at which the picture is just accurate enough. A lower price
  // gives more samples.
  const std::span<const Gain> gains(gains_.get(), gain_count_);
  double all = 0.0;
  for (const Gain& gain : gains) all += double(gain.cost);
  if (all <= 0.0 || now <= 0.0) return plan;
  const double mean_gain = now / all;
  const bool any = outcome(gains, tuning::least_gain * mean_gain).cost > 0.0;
  double low = std::log((any ? tuning::least_gain : tuning::least_gain_of_all) * mean_gain);
  double high = std::log(greatest_price);
  std::vector<Gain> worth;  // worth the lowest price; most are not
  std::ranges::copy_if(gains, std::back_inserter(worth), [&](const Gain& gain) {
    return gain.factor(static_cast<float>(std::exp(low))) > 1;
  });
  for (int k = 0; k < bisections; ++k) {
    const double middle = 0.5 * (low + high);
    const Outcome found = outcome(worth, std::exp(middle));
    const bool dearer = found.squared_error <= wanted || found.cost > most_cost;
    (dearer ? low : high) = middle;
  }
  const double per_cost = std::exp(outcome(worth, std::exp(low)).cost <= most_cost ? low : high);
  plan.squared_error = outcome(worth, per_cost).squared_error;
  for (const Gain& gain : worth) {
    const int times = gain.factor(static_cast<float>(per_cost));
    if (times == 1) continue;
    const double cost = (times - 1) * double(gain.cost);
    plan.cost += cost;
    if (gain.kind == camera_kind) {
      plan.camera[gain.index] *= static_cast<std::uint32_t>(times);
      continue;
    }
    plan.field_cost += cost;
    // Doubling adds the number so far. Four times adds four times, as sets are powers of two.
    plan.field[gain.kind][gain.index] =
        static_cast<std::uint32_t>(gain.samples) * (times == 4 ? 4U : 1U);
  }
  return plan;
}

}  // namespace earthshine::raytrace

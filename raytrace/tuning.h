// SPDX-License-Identifier: Apache-2.0
// Every constant that steers samples, denoising, rounds, aiming and look-ups, with its effect on
// error and cost and its unit. docs/renderer.md explains the method, docs/log/renderer.md has the
// values that were tried. Constants of mathematics and of memory layout are beside their use.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace earthshine::raytrace::tuning {

// --- Allocation: prices (adaptive/sample_plan.cpp) ---
// Cost of a ray, or sample, over the cost of a gather ray in a packet, measured on the payload bay.
// Too low a price draws too many samples of that kind.
inline constexpr double ray_cost = 1.5;       // a camera sample's ray
inline constexpr double path_ray_cost = 1.7;  // a ray of a residual path or of a lobe
inline constexpr double camera_cost = 3.0;    // a camera sample without its rays
// Least reduction of squared error per ray, over the mean so far: more spares rays on rough
// predictions but needs more rounds. The second one applies if no gain exceeds the first.
inline constexpr double least_gain = 0.2, least_gain_of_all = 1e-6;
// Samples up to which a pixel's own variance is not trusted: more spends samples beside noisy
// pixels, fewer leaves bias where samples agree by chance.
inline constexpr double unsure_samples = 4.0;
// Least number of pixels with one sample count for the variance reduction by stratification; with
// fewer, all pixels are used.
inline constexpr std::size_t few_pixels_of_class = 64;

// --- Allocation: rounds (adaptive/allocator.cpp) ---
// Factor on the squared error that one round may gain: more saves denoising, plans by rougher data.
inline constexpr double most_step = 4.0;
// Least cost of a round over all before: more saves denoising, overshoots the wanted error.
inline constexpr double least_step = 0.05;
// Wanted relative error from which down the initial samples are not halved.
inline constexpr double fine_error = 0.04;
// Stop fraction of the wanted error, above fine_error and below: less is safer and dearer, as
// rounds leave the errors that look too small. The true error is 0.89 to 1.08 of the stated one at
// 5 % on the payload bay, up to 1.1 at 2 %.
inline constexpr double stop_fraction_of_coarse = 0.94, stop_fraction_of_fine = 0.9;
// Fraction of the wanted error that rounds aim at: less overshoots, more needs a further round.
inline constexpr double planned_share = 0.873;
static_assert(planned_share < stop_fraction_of_fine);  // or rounds would not end
// Study conditions, each a sum of the picture's layers: those whose squared error is more than so
// many times too large get no samples of their own, and all samples together cost at most so many
// times those for the sum of all layers. More finishes more conditions at the terminators, at their
// price.
inline constexpr double most_gain_for_sums = 4.0, most_growth_for_sums = 1.5;
// The rounds for the sum of all layers end at this share of their wanted error: a condition's
// picture shows only some of the lights, and its relative error is larger.
inline constexpr double share_of_the_sum = 0.8;
// Confidence of that decision, in standard errors of the squared error (90 %, one-sided): more is
// surer of the wanted error; costs 0.6 to 5 % of the rays.
inline constexpr double one_sided_90 = 1.2816;
// Growth of the samples after which the error must have fallen to this share, or rounds give up.
inline constexpr double hopeless_growth = 1024.0, hopeless_share = 0.5;

// --- Initial samples (adaptive/allocator.h, adaptive/adaptive_render.cpp,
// gather/initial_samples.cpp) --- Of each gather point: more makes better plans and costs smooth
// pictures too much.
inline constexpr std::uint32_t initial_gather_rays = 16, initial_paths = 4, initial_lobe_rays = 2;
// Least residual paths of a picture: fewer miss light that paths seldom find.
inline constexpr std::size_t least_paths = 1U << 16U;
// Factor on the initial rays of sharp lobes, at most: less misses highlights, more costs rays.
inline constexpr double most_lobe_times = 32.0;
// Layers up to which edges get samples for the eye; more layers make these too dear.
inline constexpr std::size_t most_layers_for_eye = 8;
// Camera samples of a pixel, a power of two; half as many in smooth regions: more make better plans
// and cost smooth pictures too much.
inline constexpr int initial_camera_samples = 4;

// --- Progress (adaptive/adaptive_render.cpp); no effect on the picture ---
// Cost of an initial sample of each kind and of a camera sample, and the error of a picture of
// initial samples, on the payload bay: they predict a picture's cost until the first statement.
inline constexpr std::array<double, 3> usual_cost_of_point = {1.0, 8.0, 5.0};
inline constexpr double usual_cost_of_camera = 12.0;
inline constexpr double usual_initial_error = 0.08, least_usual_growth = 1.3;
// Cost of a picture over the one that a round predicts: later rounds, specks, denoising by layer.
inline constexpr double usual_rest = 1.15;

// --- Time limits and stops (adaptive/adaptive_render.cpp, gather/initial_samples.cpp) ---
// Time to reserve for the rest of a picture, over the time for finding the gather points (measured:
// 6 by day, 9 by night), and over the denoising time: less overruns a limit, more wastes it.
inline constexpr double after_points = 9.0, after_denoising = 4.0;
// One pixel of a square of 2 * reach + 1 is sampled after a stop, px; more leaves blur.
inline constexpr int stop_reach_px = 2;
// Sampled mirror neighbours that replace an own sample after a stop: fewer are faster and rougher.
inline constexpr int enough_mirror_neighbours = 4;

// --- Denoising (share/) ---
// Confidence margins of the Wiener gain, shares of the noise: more leaves less noise, more blur.
inline constexpr float noise_margin = 0.3F;   // of q
inline constexpr float chance_margin = 0.7F;  // of sqrt(2 / N) q
// Blurs of a window of squares; the first one is left out for all but single pixels' details. More
// make steadier gains over wider surroundings, a fifth of the denoising time each.
inline constexpr std::size_t window_blurs = 3;
// Random-sign fields for the noise, and for the standard error of the signal: more are steadier,
// each takes about a tenth of the denoising time. Eight bits per point are enough for both.
inline constexpr std::size_t noise_fields = 4, scatter_fields = 3;
// Cosine between normals of one surface (25 degrees), and the slope by which a neighbour may leave
// the tangent plane: wider shares more and blurs over bends.
inline constexpr float least_surface_cosine = 0.906F, most_surface_slope = 0.22F;
// Edge of the regions for statistics of off-grid and isolated points, px: larger is steadier, less
// local.
inline constexpr std::size_t region_px = 8;
// Neighbourhood of a point seen in a mirror, px in each direction; at most 3, the bits of 64.
inline constexpr int mirror_reach_px = 3;

// --- Gather points (gather/) ---
// Phong exponent from which on a lobe is shaded per camera sample: lower costs samples, higher
// blurs highlights.
inline constexpr double sharp_lobe = 100.0;
// Cover of a pixel that makes an off-grid point: less adds points, more leaves slivers to others.
inline constexpr float least_cover = 0.2F;
// Least reflectance of a mirror whose reflected surface gets a gather point.
inline constexpr double least_mirror = 0.01;
// Cosine between normals within which a lobe may be read (10 degrees): wider blurs highlights.
inline constexpr float lobe_cosine = 0.985F;
// Cosine between normals of neighbouring pixels beyond which rays start all over the pixel (2
// degrees): the mean of a lobe of exponent n is wrong by n 2^2 / (6 57^2) of its peak, 0.4 % for
// n = 20.
inline constexpr float turning_cosine = 0.99939F;
// Footprint over mean ray length from which on rays start all over the pixel: less costs camera
// rays, more misses gradients at contacts.
inline constexpr float alike_share = 0.1F;
// Distance of a point of the next pixel, over a pixel's half diagonal.
inline constexpr float next_pixel_radius = 3.0F;
// Gather rays to one aimed at a bright patch: fewer finds small bright patches less often.
inline constexpr std::size_t gather_rays_per_aimed = 16;

// --- Camera samples (shade/) ---
// Relative standard deviation of a neighbour's samples from which on a pixel gets two times, and
// four times the samples for the eye. The first is also the least contrast of an edge. Less costs
// samples, more shows stairs.
inline constexpr double most_scatter = 1.0 / 3.0, most_of_eight = 1.414 * most_scatter;
// Allowed error at an edge, relative to its brighter side.
inline constexpr double edge_for_eye = 0.02;
// Luminance below which contrasts do not count, over the picture's mean.
inline constexpr double dimmest_share = 0.05;
// Stated deviation of a pixel, relative to its luminance, from which on it gets more samples after
// the error is reached, in so many rounds, each for at most that share of the cost so far. A
// smaller deviation costs more, a larger one leaves single dark or bright pixels.
inline constexpr double visible_deviation = 0.5, speck_cost = 0.05;
inline constexpr std::uint32_t speck_rounds = 2;
// Least number of pixels with one sample count for a common error estimate; with fewer, all pixels
// are used.
inline constexpr std::size_t few_pixels = 64;
// Gather rays of a sample without a gather point, and of one behind a mirror or glass.
inline constexpr int rays_without_point = 2, rays_behind_mirror = 2;
// First samples of a sliver that read a neighbour's point: more blurs, fewer leaves lone pixels.
inline constexpr std::size_t samples_beside = 16;
// Rays of a sharp lobe per camera sample.
inline constexpr int lobe_rays = 4;
// Mirrors and glass before Russian roulette, and its largest survival probability: less is noisier.
inline constexpr int roulette_depth = 3;
inline constexpr double most_survival = 0.95;

// --- Paths (paths/) ---
// Share of rays off diffuse surfaces that are aimed at bright patches: 0.05 to 0.2 is as good.
inline constexpr double aimed_share = 0.25;
// Least survival probability of a residual path: less costs fewer rays, more finds light that a
// wrong solution lacks.
inline constexpr double least_survival = 0.05;
// Bounces from which on this share of residual paths survives each doubling of their length: bounds
// their mean at 640; fewer bounces are noisier in rooms that reflect nearly everything.
inline constexpr int long_walk = 128;
inline constexpr double long_walk_survival = 0.4;
// Path tracer: weight down to which paths always continue; more is faster and noisier.
inline constexpr double sure_weight = 0.25;
// Bounces after which paths may always end. The probability is so small that the variance is finite
// up to reflectances of 0.9999^(1/2).
inline constexpr int long_path = 1000;
inline constexpr double long_path_survival = 0.9999;

// --- Look-ups in the solution (incoming/) ---
// Luminance of a bright patch over the mean: less aims more rays (2 takes a third more time).
inline constexpr double bright_ratio = 16.0;

// --- Lights (light/) ---
// Number of lamps up to which all get shadow rays: a selection would cost more than it saves.
inline constexpr std::size_t few_lamps = 32;
// Share of the light above which a lamp always gets a shadow ray: less has less noise, more rays.
inline constexpr double smallest_share = 1.0 / 16.0;
// Strata of the Suns of a sky in parts, a power of two: more saves shadow rays of paths, but each
// Sun is noisier.
inline constexpr std::size_t most_sun_sets = 4;
// Distance of a lamp, in footprints, up to which a second point is sampled. Farther away the
// illuminance varies by at most half within the footprint.
inline constexpr double near_lengths = 2.0;
// Cosine of the view below which there is no second point: the plane ends within the pixel.
inline constexpr double flattest = 0.05;
// Most rays to find a hit on the plane.
inline constexpr int most_footprint_rays = 256;

// --- Witness: listed spots (witness/images.cpp, spot_map.cpp) ---
// Image area from which on camera samples find a source without the witness, px^2.
inline constexpr double large_px2 = 1.0;
// Least Phong exponent of a listed highlight; wider ones exceed the bodies that show them.
inline constexpr double least_shininess = 50.0;
// Squared standard deviations beyond which a lobe is dark.
inline constexpr double most_deviations2 = 16.0;
// Most pairs of facets and emitting triangles: more costs time in large meshes.
inline constexpr double most_pairs = 4e6;
// Least part of a spot in a pixel, over the largest part in any pixel, along an axis.
inline constexpr double least_part = 1.0 / 32.0;

// --- Witness: strips (witness/strip_width.h, source_strips.cpp, light_strips.cpp) ---
// Largest width of a strip, px.
inline constexpr double wide_px = 1.0;
// Trial widths over wide_px, and bisections after them: rays per strip.
inline constexpr std::array<double, 4> strip_places = {1.0 / 64.0, 1.0 / 16.0, 1.0 / 4.0, 1.0};
inline constexpr int strip_bisections = 4;
// Steps along edges, px, distance of probes beside them, px, and most steps: rays.
inline constexpr double step_px = 0.5, beside_px = 5e-4;
inline constexpr std::size_t most_probes = 16384;
// Corners of a round rim; most mirrors and panes on the way to a source.
inline constexpr int round_corners = 32, most_bounces = 8;
// Most panes in front of a strip of light; most parts of a strip, and their length, px.
inline constexpr int most_panes = 8, most_parts = 64;
inline constexpr double part_px = 0.5;
// Radius of a source over the scene's diagonal beyond which its strips are not sharp.
inline constexpr double widest = 0.05;
// Largest width of a strip of light whose reflection paths may miss, over the scene's diagonal.
inline constexpr double wide_share = 0.02;
// Places along such a strip that are tested for light.
inline constexpr int strip_parts = 8;
// Spots that represent all such strips, and blocks of pixels that they may light: rays.
inline constexpr std::size_t most_lit_spots = 32;
inline constexpr double most_blocks = 1024.0;
// Least distance of a spot from a surface that it lights, over the scene's diagonal: a nearer one
// would count for many.
inline constexpr double near_spot = 0.05;

// --- Witness: samples (witness/witness.cpp, source_edges.cpp) ---
// Expected samples on a spot, least and most: more give more confidence.
inline constexpr double fewest_hits = 16.0, most_hits = 64.0;
// Share of the wanted error for unsampled spots, and for a source's rim.
inline constexpr double noise_share = 0.25, source_share = 1.0 / 3.0;
// Samples of a pixel without the witness.
inline constexpr double few_samples = 4.0;
// Least light of a listed spot in a pixel, over the wanted error times the mean luminance.
inline constexpr double least_of_spot = 0.01;
// A pixel covered at least this much needs no samples for spots.
inline constexpr double most_coverage = 0.999;
// Most samples of one pixel; of the picture, the larger of a total and a number per pixel.
inline constexpr double most_for_one = 65536.0;
inline constexpr double witness_samples = 1048576.0, witness_per_pixel = 4.0;
// Most of the remaining time of a limit.
inline constexpr double time_for_witness = 0.25;
// Share of the expected light below which samples have missed a spot: surfaces may hide a part of
// it, so that more causes false alarms.
inline constexpr double found_share = 0.125;
// Samples of a pixel at the edge of a visible source, least and most, and least contrast of such an
// edge.
inline constexpr std::uint32_t fewest_at_source = 64, most_at_source = 1024;
inline constexpr double least_contrast = 1.0 / 3.0;

}  // namespace earthshine::raytrace::tuning

// SPDX-License-Identifier: Apache-2.0
// The contents of a solution file: one list of the members of a Solution and its report, used for
// reading and writing. Members are const when written. A Store has
//   facets, tree, patches, groups                          their numbers
//   column(name, std::vector<T>&, shape, unit, meaning)     numbers
//   rows(name, records, member, unit, meaning)              one member of every record
//   value(name, T&)                                         an attribute of the file
//   optional(name, double&)                                 an attribute that is omitted if 0
#pragma once

#include "radiosity/patches/patch_layout.h"
#include "radiosity/solution.h"

namespace earthshine::radiosity {

template <class Store, class Layout>
void visit_layout(Store& store, Layout& layout) {
  const auto per_facet = [&](const char* name, auto& values, const char* meaning) {
    store.column(name, values, {store.facets}, "", meaning);
  };
  per_facet("facets/s_count", layout.s_count, "rows of the facet's grid of cells");
  per_facet("facets/t_count", layout.t_count, "columns of the facet's grid of cells");
  per_facet("facets/first_front", layout.first_front, "first patch of the front");
  per_facet("facets/first_back", layout.first_back, "first patch of a sheet's back; 2^32-1: none");
  per_facet("facets/leaves", layout.leaves, "patches of each side");
  per_facet("facets/tree_start", layout.tree_start, "start in facets/tree; 2^32-1: no cell split");
  store.column("facets/tree", layout.tree, {store.tree}, "",
               "leaf number, or 2^31 + start of its two halves, + 2^30 if they lie along t");
  store.optional("cluster_edge_m", layout.cluster_edge_m);
  store.column("area", layout.area_m2, {store.patches}, "m2", "area of the patch");
}

template <class Store, class AnySolution>
void visit_light(Store& store, AnySolution& solution) {
  const auto light = [&](const char* name, auto& values, const char* unit, const char* meaning) {
    store.column(name, values, {store.patches, store.groups, 3}, unit, meaning);
  };
  light("radiosity", solution.radiosity, "lm/m2",
        "per patch, light group and R, G, B: all that leaves diffusely, but the exitance of small "
        "emitting surfaces");
  light("soft_radiosity", solution.indirect_radiosity, "lm/m2",
        "the part of radiosity not due to explicitly sampled sources");
  light("illuminance_direct", solution.direct_lx, "lx",
        "from Sun, Earth, lamps and small emitting surfaces");
  light("illuminance_indirect", solution.indirect_lx, "lx", "from other patches");
}

template <class Store, class Report>
void visit_report(Store& store, Report& report) {
  store.value("refinement_rays", report.refinement_rays);
  store.rows("refinement/patches", report.rounds, &RefineRound::patches, "", "after each round");
  store.rows("refinement/error", report.rounds, &RefineRound::error, "", "estimated, relative");
  store.value("form_factor_rays_cast", report.form_factor_rays);
  store.value("rays_per_patch", report.rays_per_patch);
  store.value("shadow_rays", report.shadow_rays);
  store.value("nonzeros", report.nonzeros);
  store.value("iterations", report.iterations);
  store.value("residual", report.residual);
  store.value("solver_error", report.solver_error);
  store.value("back_share", report.back_share);
  store.value("balance_sweeps", report.balance.sweeps);
  store.value("balance_before", report.balance.before);
  store.value("balance_after", report.balance.after);
  store.value("balance_borrowed", report.balance.borrowed);
  store.value("balance_filled", report.balance.filled);
  store.value("balance_held", report.balance.held);
  store.value("balance_balanced", report.balance.balanced);
  store.value("balance_worst", report.balance.worst);

  auto& groups = report.groups;
  store.rows("ledger/group", groups, &GroupLedger::name, "", "light group");
  store.rows("ledger/given", groups, &GroupLedger::given_lm, "lm", "by all sources");
  store.rows("ledger/escaped_at_once", groups, &GroupLedger::escaped_at_once_lm, "lm", "");
  store.rows("ledger/lost_at_once", groups, &GroupLedger::lost_at_once_lm, "lm", "on black backs");
  store.rows("ledger/emitted", groups, &GroupLedger::emitted_lm, "lm", "by patches");
  store.rows("ledger/landed", groups, &GroupLedger::landed_lm, "lm", "directly");
  store.rows("ledger/absorbed", groups, &GroupLedger::absorbed_lm, "lm", "");
  store.rows("ledger/escaped", groups, &GroupLedger::escaped_lm, "lm", "");
  store.rows("ledger/imbalance", groups, &GroupLedger::imbalance, "", "relative");

  auto& sources = report.sources;
  store.rows("sources/name", sources, &SourceFlux::name, "", "");
  store.rows("sources/group", sources, &SourceFlux::group, "", "number of its light group");
  store.rows("sources/emitted", sources, &SourceFlux::emitted_lm, "lm", "");
  store.rows("sources/escaped_share", sources, &SourceFlux::escaped_share, "", "");
  store.rows("sources/black_share", sources, &SourceFlux::back_share, "", "on black backs");
  store.rows("sources/share_std_error", sources, &SourceFlux::share_std_error, "", "");
  store.rows("sources/landed", sources, &SourceFlux::landed_lm, "lm", "on patches");
  store.rows("sources/scale", sources, &SourceFlux::scale, "", "of the sampled illuminance");

  auto& objects = report.objects;
  store.rows("objects/name", objects, &ObjectLight::name, "", "");
  store.rows("objects/area", objects, &ObjectLight::area_m2, "m2", "");
  store.rows("objects/illuminance", objects, &ObjectLight::illuminance_lx, "lx",
             "mean over the area, all light groups");
  store.rows("objects/radiosity", objects, &ObjectLight::radiosity_lm_m2, "lm/m2",
             "mean over the area, all light groups");
  store.rows("objects/back_share", objects, &ObjectLight::back_share, "",
             "of the rays that met it, those that met its back");
}

}  // namespace earthshine::radiosity

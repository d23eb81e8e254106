// SPDX-License-Identifier: Apache-2.0
#include "degrade/certify/certificate.h"

#include <algorithm>

#include "degrade/certify/test_bench.h"

namespace earthshine::degrade {

Result still_chain(const base::Image& radiance, const CctvCamera& camera, const Monitor& monitor,
                   const Options& options) {
  return degrade(radiance, camera, monitor, options);
}

int Certificate::count(Verdict verdict) const {
  return static_cast<int>(std::count_if(
      rows.begin(), rows.end(), [&](const CertificateRow& row) { return row.verdict == verdict; }));
}

std::string Certificate::failures() const {
  std::string text;
  for (const CertificateRow& row : rows) {
    if (row.verdict != Verdict::Fail) continue;
    text += (text.empty() ? "" : "; ") + row.group + ": " + row.name;
  }
  return text;
}

Certificate certify(const CctvCamera& camera, const Monitor& monitor,
                    const CertifyOptions& options) {
  const Bench bench(camera, monitor, options);
  Certificate certificate;
  const auto add = [&](std::string_view group, Rows rows) {
    for (CertificateRow& row : rows) {
      row.group = group;
      certificate.rows.push_back(std::move(row));
    }
  };
  add("photon transfer", photon_transfer_rows(bench, certificate.photon_transfer));
  add("optics", optics_rows(bench));
  add("electronics", electronics_rows(bench));
  add("slanted edge", edge_rows(bench, certificate.sharpness));
  add("iris", iris_rows(bench));
  add("raster", raster_rows(bench));
  add("repeatability", repeatability_rows(bench));
  return certificate;
}

}  // namespace earthshine::degrade

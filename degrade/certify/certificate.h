// SPDX-License-Identifier: Apache-2.0
// A camera's certificate: the whole chain is measured like a camera on a test bench. Each result is
// compared with its closed form from the camera's settings.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "base/image.h"
#include "degrade/chain.h"

namespace earthshine::degrade {

enum class Verdict { Pass, Fail, DoesNotApply };
[[nodiscard]] constexpr std::array<std::string_view, 3> words_of(Verdict) {
  return {"pass", "fail", "does not apply"};
}

struct CertificateRow {
  std::string group, name, unit;
  double measured = 0.0, expected = 0.0;
  double tolerance = 0.0;    // on |measured - expected|
  bool statistical = false;  // the tolerance is four standard errors
  std::string law;           // source of `expected`
  Verdict verdict = Verdict::DoesNotApply;
  std::string why;  // reason if it does not apply
};

// Data for the graphs of a datasheet. Signals are linear, before gamma, 1 at white.
struct TransferPoint {
  double signal = 0.0, mean = 0.0, in_time = 0.0, in_space = 0.0;  // variances
  double law_in_time = 0.0, law_in_space = 0.0;
};
struct SharpnessPoint {
  double frequency = 0.0;  // cycles per resel, along the normal of an edge tilted by 5 degrees
  double along = 0.0, across = 0.0, law_along = 0.0, law_across = 0.0;
};

struct Certificate {
  std::vector<CertificateRow> rows;
  std::vector<TransferPoint> photon_transfer;
  std::vector<SharpnessPoint> sharpness;

  [[nodiscard]] int count(Verdict verdict) const;
  [[nodiscard]] bool passed() const { return count(Verdict::Fail) == 0; }
  // The rows that fail: "photon transfer: noise of the light b; ...".
  [[nodiscard]] std::string failures() const;
};

using Chain =
    std::function<Result(const base::Image&, const CctvCamera&, const Monitor&, const Options&)>;

// degrade() of a still scene, without memory.
[[nodiscard]] Result still_chain(const base::Image& radiance, const CctvCamera& camera,
                                 const Monitor& monitor, const Options& options);

struct CertifyOptions {
  std::uint64_t seed = 1;
  Chain chain = still_chain;  // the chain under test
};

// Smallest monitor for a certificate, resels in each direction.
inline constexpr int least_certified_resels = 64;

// Throws base::Error (Input) if the monitor has fewer resels.
[[nodiscard]] Certificate certify(const CctvCamera& camera, const Monitor& monitor,
                                  const CertifyOptions& options = {});

}  // namespace earthshine::degrade

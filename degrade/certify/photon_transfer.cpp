// SPDX-License-Identifier: Apache-2.0
#include "degrade/certify/photon_transfer.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace earthshine::degrade {
namespace {

// Powers of the signal with a coefficient each.
using Powers = std::vector<int>;

// The coefficients by weighted least squares: (X' W X)^-1 X' W v for each block's variances v.
std::vector<Estimate> fit(std::span<const FlatField> fields,
                          const std::vector<double> FlatField::*variances,
                          const std::vector<double>& weights, const Powers& powers) {
  const auto levels = static_cast<Eigen::Index>(fields.size());
  const auto unknowns = static_cast<Eigen::Index>(powers.size());
  const auto blocks = static_cast<Eigen::Index>((fields.front().*variances).size());
  Eigen::MatrixXd x(levels, unknowns), v(levels, blocks);
  for (Eigen::Index level = 0; level < levels; ++level) {
    const FlatField& field = fields[static_cast<std::size_t>(level)];
    for (Eigen::Index k = 0; k < unknowns; ++k) {
      x(level, k) = std::pow(field.signal, powers[static_cast<std::size_t>(k)]);
    }
    v.row(level) = Eigen::Map<const Eigen::RowVectorXd>((field.*variances).data(), blocks);
  }
  const auto w = Eigen::Map<const Eigen::VectorXd>(weights.data(), levels).asDiagonal();
  const Eigen::MatrixXd normal = x.transpose() * w * x;
  const Eigen::MatrixXd found = normal.ldlt().solve(x.transpose() * w * v);
  std::vector<Estimate> result;
  for (Eigen::Index k = 0; k < unknowns; ++k) {
    const Eigen::RowVectorXd row = found.row(k);
    result.push_back(mean_of({row.begin(), row.end()}));
  }
  return result;
}

}  // namespace

FlatField measure_flat(double signal, std::span<const Picture> frames,
                       const std::vector<Block>& blocks) {
  FlatField field;
  field.signal = signal;
  const double count = static_cast<double>(frames.size());
  const int columns = frames.front().columns;
  for (std::size_t plane = 0; plane < frames.front().planes.size(); ++plane) {
    const auto mean_at = [&](std::size_t i) {
      double sum = 0.0;
      for (const Picture& frame : frames) sum += static_cast<double>(frame.planes[plane][i]);
      return sum / count;
    };
    double whole = 0.0;
    for (const Picture& frame : frames) {
      whole += plane_mean(frame.planes[plane], columns, blocks) / count;
    }
    for (const Block& block : blocks) {
      field.mean.push_back(block_mean(block, columns, mean_at));
      const double in_time = block_mean(block, columns, [&](std::size_t i) {
        const double mean = mean_at(i);
        double squares = 0.0;
        for (const Picture& frame : frames) {
          const double d = static_cast<double>(frame.planes[plane][i]) - mean;
          squares += d * d;
        }
        return squares / (count - 1.0);
      });
      field.in_time.push_back(in_time);
      field.in_space.push_back(block_mean(block, columns,
                                          [&](std::size_t i) {
                                            const double d = mean_at(i) - whole;
                                            return d * d;
                                          }) -
                               in_time / count);
    }
  }
  return field;
}

PhotonTransfer fit_photon_transfer(std::span<const FlatField> fields) {
  std::vector<double> variances;
  for (const FlatField& field : fields) {
    variances.push_back(mean_of(field.in_time).value + std::abs(mean_of(field.in_space).value));
  }
  // A level without any noise would take all the weight.
  const double least =
      std::max(1e-6 * *std::max_element(variances.begin(), variances.end()), 1e-20);
  std::vector<double> weights;
  weights.reserve(variances.size());
  for (const double variance : variances) {
    weights.push_back(1.0 / std::pow(std::max(variance, least), 2.0));
  }
  const double scale = *std::min_element(weights.begin(), weights.end());
  for (double& weight : weights) weight /= scale;
  const std::vector<Estimate> time = fit(fields, &FlatField::in_time, weights, {0, 1, 2});
  const std::vector<Estimate> space = fit(fields, &FlatField::in_space, weights, {0, 2});
  return {time[0], time[1], time[2], space[0], space[1]};
}

}  // namespace earthshine::degrade

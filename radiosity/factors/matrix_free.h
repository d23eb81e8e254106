// SPDX-License-Identifier: Apache-2.0
// A linear operator without a matrix, as Eigen's iterative solvers take it: one that looks like a
// sparse matrix (Eigen's "Matrix-free solvers").
#pragma once

#include <Eigen/Core>
#include <Eigen/IterativeLinearSolvers>
#include <Eigen/SparseCore>
#include <cstddef>
#include <functional>
#include <utility>

namespace earthshine::radiosity {
class MatrixFree;
}

namespace Eigen::internal {
template <>
struct traits<earthshine::radiosity::MatrixFree> : public traits<Eigen::SparseMatrix<double>> {};
}  // namespace Eigen::internal

namespace earthshine::radiosity {

// Square and linear. Solvers keep a pointer to it.
class MatrixFree : public Eigen::EigenBase<MatrixFree> {
 public:
  using Scalar = double;
  using RealScalar = double;
  using StorageIndex = int;
  enum {
    ColsAtCompileTime = Eigen::Dynamic,
    MaxColsAtCompileTime = Eigen::Dynamic,
    IsRowMajor = 0
  };
  using Apply = std::function<Eigen::VectorXd(const Eigen::VectorXd& x)>;

  MatrixFree(std::size_t size, Apply apply_to)
      : apply_(std::move(apply_to)), size_(static_cast<Eigen::Index>(size)) {}

  [[nodiscard]] Eigen::Index rows() const { return size_; }
  [[nodiscard]] Eigen::Index cols() const { return size_; }

  template <class Rhs>
  Eigen::Product<MatrixFree, Rhs, Eigen::AliasFreeProduct> operator*(
      const Eigen::MatrixBase<Rhs>& x) const {
    return {*this, x.derived()};
  }

  [[nodiscard]] Eigen::VectorXd apply(const Eigen::VectorXd& x) const { return apply_(x); }

 private:
  Apply apply_;
  Eigen::Index size_;
};

}  // namespace earthshine::radiosity

namespace Eigen::internal {
template <class Rhs>
struct generic_product_impl<earthshine::radiosity::MatrixFree, Rhs, SparseShape, DenseShape,
                            GemvProduct>
    : generic_product_impl_base<earthshine::radiosity::MatrixFree, Rhs,
                                generic_product_impl<earthshine::radiosity::MatrixFree, Rhs>> {
  template <class Dest>
  static void scaleAndAddTo(Dest& y, const earthshine::radiosity::MatrixFree& op, const Rhs& x,
                            const double& alpha) {
    y.noalias() += alpha * op.apply(x);
  }
};
}  // namespace Eigen::internal

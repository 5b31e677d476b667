#pragma once

#include <optional>

#include "core/base/progress.h"
#include "core/flow/sparse.h"

namespace lamella::flow {

/// A symmetric positive definite V-cycle for a scalar matrix like that of the Laplacian on any
/// mesh: smoothed aggregation (Vanek, Mandel and Brezina 1996), aggregates grown along strong
/// couplings only, so that stretched elements are coarsened across their short side first.
///
/// The result of a cycle does not depend on the thread count: the smoother, symmetric Gauss-Seidel,
/// works in blocks of rows of fixed size, whose couplings among one another are added to the
/// diagonal (Baker, Falgout, Kolev and Yang 2011). All calls are made in the arena of the caller.
class Multigrid {
 public:
  /// Rows without a coupling (fixed nodes) are kept out of the coarse levels. With one level a
  /// cycle is one symmetric Gauss-Seidel sweep, or exact when there are few rows. Nullopt when
  /// cancelled.
  static std::optional<Multigrid> build(Csr matrix, const Progress& progress,
                                        std::size_t most_levels = 30);

  /// x = V b for K = 1, 2 or 3 columns at once. Not to be called twice at the same time.
  template <int K>
  void apply(const std::vector<Vec<K>>& b, std::vector<Vec<K>>& x);

  int levels() const { return static_cast<int>(levels_.size()); }
  /// Entries of all levels over those of the first.
  double complexity() const;
  const Csr& matrix() const { return levels_.front().a; }

 private:
  template <int K>
  struct Work {
    std::vector<Vec<K>> b, x, r;
  };
  struct Level {
    Csr a, prolong, restrict_to;
    std::vector<double> inverse;  ///< of the diagonal with the couplings that leave the block
    std::size_t block = 0;        ///< rows
    Work<1> one;
    Work<2> two;
    Work<3> three;
    template <int K>
    Work<K>& work() {
      if constexpr (K == 1)
        return one;
      else if constexpr (K == 2)
        return two;
      else
        return three;
    }
  };

  void finish(Level& level);
  template <int K>
  void cycle(std::size_t at, const std::vector<Vec<K>>& b, std::vector<Vec<K>>& x);
  template <int K>
  void solve_coarsest(const std::vector<Vec<K>>& b, std::vector<Vec<K>>& x);

  std::vector<Level> levels_;
  Eigen::LDLT<Eigen::MatrixXd> coarsest_;
  bool direct_ = false;
};

}  // namespace lamella::flow

#pragma once

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/geometry/simplex.h"

namespace lamella::flow {

/// A square or rectangular matrix by compressed rows, columns ascending in each row.
struct Csr {
  std::int32_t columns = 0;
  std::vector<std::int32_t> start{0};  ///< [row]; the entries of row i are [start[i], start[i + 1])
  std::vector<std::int32_t> column;    ///< [entry]
  std::vector<double> value;           ///< [entry]

  std::int32_t rows() const { return static_cast<std::int32_t>(start.size()) - 1; }
};

/// Calls work(begin, end) for ranges of [0, count), cut at multiples of `block` whatever the thread
/// count is. In the arena of the caller.
template <class Work>
void for_blocks(std::size_t count, Work&& work, std::size_t block = 2048) {
  const std::size_t blocks = (count + block - 1) / block;
  const auto one = [&](std::size_t b) { work(b * block, std::min(count, (b + 1) * block)); };
  if (blocks <= 2) {
    for (std::size_t b = 0; b < blocks; ++b) one(b);
  } else {
    tbb::parallel_for(std::size_t{0}, blocks, one);
  }
}

/// The sum of part(begin, end) over the blocks, added in their order: the same for any thread
/// count.
template <class Part>
double block_sum(std::size_t count, Part&& part, std::size_t block = 2048) {
  std::vector<double> parts((count + block - 1) / block);
  for_blocks(
      count, [&](std::size_t b, std::size_t e) { parts[b / block] = part(b, e); }, block);
  double sum = 0;
  for (const double p : parts) sum += p;
  return sum;
}

/// y = A x, for K columns at once.
template <int K>
void multiply(const Csr& a, const std::vector<Vec<K>>& x, std::vector<Vec<K>>& y) {
  for_blocks(static_cast<std::size_t>(a.rows()), [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      Vec<K> sum = Vec<K>::Zero();
      for (std::int32_t e = a.start[i]; e < a.start[i + 1]; ++e) sum += a.value[e] * x[a.column[e]];
      y[i] = sum;
    }
  });
}

Csr transpose(const Csr& a);
/// A B, by rows and in parallel; in the arena of the caller.
Csr product(const Csr& a, const Csr& b);

}  // namespace lamella::flow

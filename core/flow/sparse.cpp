#include "core/flow/sparse.h"

namespace lamella::flow {

Csr transpose(const Csr& a) {
  Csr t;
  t.columns = a.rows();
  t.start.assign(static_cast<std::size_t>(a.columns) + 1, 0);
  for (const std::int32_t c : a.column) ++t.start[c + 1];
  for (std::size_t i = 0; i + 1 < t.start.size(); ++i) t.start[i + 1] += t.start[i];
  t.column.resize(a.column.size());
  t.value.resize(a.value.size());
  std::vector<std::int32_t> next(t.start.begin(), t.start.end() - 1);
  for (std::int32_t i = 0; i < a.rows(); ++i)
    for (std::int32_t e = a.start[i]; e < a.start[i + 1]; ++e) {
      const std::int32_t to = next[a.column[e]]++;
      t.column[to] = i;
      t.value[to] = a.value[e];
    }
  return t;
}

Csr product(const Csr& a, const Csr& b) {
  // Rows of the product in pieces, each with a marker of its own, then put together.
  constexpr std::size_t kPiece = 8192;
  const auto rows = static_cast<std::size_t>(a.rows());
  struct Piece {
    std::vector<std::int32_t> length, column;
    std::vector<double> value;
  };
  std::vector<Piece> pieces((rows + kPiece - 1) / kPiece);
  const auto fill = [&](std::size_t begin, std::size_t end) {
    Piece& piece = pieces[begin / kPiece];
    std::vector<std::int32_t> place(static_cast<std::size_t>(b.columns), -1);
    std::vector<std::int32_t> row;
    std::vector<double> sum;
    std::vector<std::int32_t> order;
    for (std::size_t i = begin; i < end; ++i) {
      row.clear();
      sum.clear();
      for (std::int32_t e = a.start[i]; e < a.start[i + 1]; ++e) {
        const std::int32_t k = a.column[e];
        for (std::int32_t f = b.start[k]; f < b.start[k + 1]; ++f) {
          const std::int32_t j = b.column[f];
          if (place[j] < 0) {
            place[j] = static_cast<std::int32_t>(row.size());
            row.push_back(j);
            sum.push_back(0);
          }
          sum[place[j]] += a.value[e] * b.value[f];
        }
      }
      order = row;
      std::sort(order.begin(), order.end());
      for (const std::int32_t j : order) {
        piece.column.push_back(j);
        piece.value.push_back(sum[place[j]]);
      }
      for (const std::int32_t j : row) place[j] = -1;
      piece.length.push_back(static_cast<std::int32_t>(row.size()));
    }
  };
  for_blocks(rows, fill, kPiece);

  Csr out;
  out.columns = b.columns;
  out.start.reserve(rows + 1);
  for (const Piece& piece : pieces)
    for (const std::int32_t n : piece.length) out.start.push_back(out.start.back() + n);
  out.column.resize(static_cast<std::size_t>(out.start.back()));
  out.value.resize(out.column.size());
  for_blocks(
      rows,
      [&](std::size_t begin, std::size_t) {
        Piece& piece = pieces[begin / kPiece];
        std::copy(piece.column.begin(), piece.column.end(), out.column.begin() + out.start[begin]);
        std::copy(piece.value.begin(), piece.value.end(), out.value.begin() + out.start[begin]);
        piece = {};
      },
      kPiece);
  return out;
}

}  // namespace lamella::flow

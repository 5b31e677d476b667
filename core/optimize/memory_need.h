#pragma once

namespace lamella {

/// Bytes an element takes at the most while a round of `adapt` is under way, its share of the nodes
/// and the result included (measured, rounded up).
template <int D>
inline constexpr double bytes_an_element = D == 2   ? 400
                                           : D == 3 ? 220
                                                    : 240;

}  // namespace lamella

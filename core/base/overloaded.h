#pragma once

namespace lamella {

/// One visitor of a variant made of a lambda for each of its cases.
template <class... Cases>
struct Overloaded : Cases... {
  using Cases::operator()...;
};
/// Clang 14 does not find this out by itself.
template <class... Cases>
Overloaded(Cases...) -> Overloaded<Cases...>;

}  // namespace lamella

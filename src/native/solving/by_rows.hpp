// One object of a template over the number of rows of a problem: 3, 6, or any other.
#pragma once

#include <Eigen/Core>
#include <type_traits>
#include <utility>
#include <variant>

#include "../problem/problem.hpp"

namespace pinik {

template <template <int> class Method>
class ByRows {
 public:
  // Make the object for a problem, which is its first argument.
  template <class Asked, class... Rest>
  void make(Asked& problem, Rest&&... rest) {
    if (problem.rows == 3)
      method_.template emplace<1>(problem, std::forward<Rest>(rest)...);
    else if (problem.rows == 6)
      method_.template emplace<2>(problem, std::forward<Rest>(rest)...);
    else
      method_.template emplace<3>(problem, std::forward<Rest>(rest)...);
  }

  // Call `act` with the object, if it has been made.
  template <class Do>
  void with(const Do& act) {
    std::visit(
        [&](auto& method) {
          if constexpr (!std::is_same_v<std::decay_t<decltype(method)>, std::monostate>) act(method);
        },
        method_);
  }

 private:
  std::variant<std::monostate, Method<3>, Method<6>, Method<Eigen::Dynamic>> method_;
};

}  // namespace pinik

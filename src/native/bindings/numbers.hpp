// Numbers read from and written to NumPy arrays.
#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

#include <cstddef>
#include <initializer_list>
#include <memory>
#include <utility>
#include <vector>

#include "../problem/targets.hpp"

namespace pinik {

namespace nb = nanobind;

// The length of a row that encodes a goal: position (3), rotation (9, row by row), direction (3), at (3).
constexpr int numbers_of_a_goal = 18;

// Import NumPy; the functions below need it.
void import_numpy();

Goal goal_from(const double* row);
std::vector<Goal> goals_from(const double* rows, std::size_t count);
nb::object as_array(const Goal& goal);

// Write the row of a goal that has no direction; the rotation is zero if it is not asked for.
void write_goal(const Goal& goal, bool asks_rotation, double* row);

// The numbers of a contiguous float64 array of this shape; null for anything else, such as a masked array.
const double* numbers_of(nb::handle array, std::initializer_list<std::ptrdiff_t> shape);

// The numbers of a contiguous float64 array (count, *shape), whose `count` is set; null for anything else.
const double* blocks_of(nb::handle array, std::initializer_list<std::ptrdiff_t> shape, std::size_t& count);

nb::object as_array(const Vector& numbers);

// A new array of this shape, whose numbers are not set, and where they lie.
std::pair<nb::object, double*> new_array(std::initializer_list<std::size_t> shape);

// An array that takes over the values.
template <class T>
nb::object as_array(std::vector<T>&& values, std::initializer_list<std::size_t> shape) {
  auto kept = std::make_unique<std::vector<T>>(std::move(values));
  const nb::capsule owner(kept.get(), [](void* pointer) noexcept { delete static_cast<std::vector<T>*>(pointer); });
  return nb::cast(nb::ndarray<nb::numpy, T>(kept.release()->data(), shape, owner));
}

}  // namespace pinik

#include "numbers.hpp"

#define NPY_NO_DEPRECATED_API NPY_1_7_API_VERSION
#include <numpy/arrayobject.h>

#include <algorithm>

namespace pinik {

namespace {

using RowMajor = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

// Whether an array is contiguous float64 with `more` dimensions of any length before those of `shape`.
bool has_shape(PyArrayObject* array, std::initializer_list<std::ptrdiff_t> shape, int more) {
  return PyArray_TYPE(array) == NPY_DOUBLE && PyArray_ISCARRAY_RO(array) &&
         PyArray_NDIM(array) == static_cast<int>(shape.size()) + more &&
         std::equal(shape.begin(), shape.end(), PyArray_DIMS(array) + more);
}

}  // namespace

void import_numpy() {
  if (_import_array() < 0) throw nb::python_error();
}

Goal goal_from(const double* row) {
  Goal goal;
  goal.position = Eigen::Map<const Vec3>(row);
  goal.rotation = Eigen::Map<const RowMajor>(row + 3);
  goal.direction = Eigen::Map<const Vec3>(row + 12);
  goal.at = Eigen::Map<const Vec3>(row + 15);
  return goal;
}

std::vector<Goal> goals_from(const double* rows, std::size_t count) {
  std::vector<Goal> goals;
  for (std::size_t t = 0; t < count; ++t) goals.push_back(goal_from(rows + numbers_of_a_goal * t));
  return goals;
}

nb::object as_array(const Goal& goal) {
  Vector row(numbers_of_a_goal);
  const RowMajor R = goal.rotation;
  row << goal.position, Eigen::Map<const Eigen::Matrix<double, 9, 1>>(R.data()), goal.direction, goal.at;
  return as_array(row);
}

const double* numbers_of(nb::handle array, std::initializer_list<std::ptrdiff_t> shape) {
  if (!PyArray_CheckExact(array.ptr())) return nullptr;
  auto* own = reinterpret_cast<PyArrayObject*>(array.ptr());
  return has_shape(own, shape, 0) ? static_cast<const double*>(PyArray_DATA(own)) : nullptr;
}

const double* blocks_of(nb::handle array, std::initializer_list<std::ptrdiff_t> shape, std::size_t& count) {
  if (!PyArray_CheckExact(array.ptr())) return nullptr;
  auto* own = reinterpret_cast<PyArrayObject*>(array.ptr());
  if (!has_shape(own, shape, 1)) return nullptr;
  count = static_cast<std::size_t>(PyArray_DIM(own, 0));
  return static_cast<const double*>(PyArray_DATA(own));
}

void write_goal(const Goal& goal, bool asks_rotation, double* row) {
  std::fill_n(row, numbers_of_a_goal, 0.0);
  std::copy_n(goal.position.data(), 3, row);
  const RowMajor R = goal.rotation;
  if (asks_rotation) std::copy_n(R.data(), 9, row + 3);
}

nb::object as_array(const Vector& numbers) {
  const auto [array, own] = new_array({static_cast<std::size_t>(numbers.size())});
  std::copy_n(numbers.data(), numbers.size(), own);
  return array;
}

std::pair<nb::object, double*> new_array(std::initializer_list<std::size_t> shape) {
  npy_intp lengths[3];
  std::copy(shape.begin(), shape.end(), lengths);
  nb::object array = nb::steal(PyArray_SimpleNew(static_cast<int>(shape.size()), lengths, NPY_DOUBLE));
  if (!array.is_valid()) throw nb::python_error();
  return {array, static_cast<double*>(PyArray_DATA(reinterpret_cast<PyArrayObject*>(array.ptr())))};
}

}  // namespace pinik

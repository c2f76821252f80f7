#include "numbers.hpp"

#define NPY_NO_DEPRECATED_API NPY_1_7_API_VERSION
#include <numpy/arrayobject.h>

#include <algorithm>

namespace pinik {

namespace {

using RowMajor = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

// A rotation matrix up to the last bits. Python checks anything less exact, since it also reports what is wrong.
bool is_rotation(const Mat3& R) {
  return (R * R.transpose() - Mat3::Identity()).cwiseAbs().maxCoeff() < 1e-14 && R.determinant() > 0.0;
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
  if (!PyArray_Check(array.ptr())) return nullptr;
  auto* own = reinterpret_cast<PyArrayObject*>(array.ptr());
  const bool fits = PyArray_TYPE(own) == NPY_DOUBLE && PyArray_ISCARRAY_RO(own) &&
                    PyArray_NDIM(own) == static_cast<int>(shape.size()) &&
                    std::equal(shape.begin(), shape.end(), PyArray_DIMS(own));
  return fits ? static_cast<const double*>(PyArray_DATA(own)) : nullptr;
}

const double* rows_of(nb::handle array, std::ptrdiff_t columns, std::size_t& count) {
  if (!PyArray_Check(array.ptr())) return nullptr;
  auto* own = reinterpret_cast<PyArrayObject*>(array.ptr());
  if (PyArray_NDIM(own) != 2) return nullptr;
  count = static_cast<std::size_t>(PyArray_DIM(own, 0));
  return numbers_of(array, {PyArray_DIM(own, 0), columns});
}

std::optional<Goal> goal_at(const Term& term, nb::handle place, double farthest) {
  Goal goal;
  if (term.asks_axis) return std::nullopt;
  if (const double* matrix = numbers_of(place, {4, 4})) {
    const Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>> M(matrix);
    goal.position = M.topRightCorner<3, 1>();
    goal.rotation = M.topLeftCorner<3, 3>();
    if (M.row(3) != Eigen::RowVector4d(0.0, 0.0, 0.0, 1.0) || !is_rotation(goal.rotation)) return std::nullopt;
  } else if (const double* point = numbers_of(place, {3}); point && !term.asks_rotation) {
    goal.position = Eigen::Map<const Vec3>(point);
  } else {
    return std::nullopt;
  }
  if (!goal.position.allFinite() || goal.position.cwiseAbs().maxCoeff() > farthest) return std::nullopt;
  return goal;
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

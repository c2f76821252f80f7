// The Python module pinik._native; pinik.native is its only user.
#include <nanobind/eigen/dense.h>
#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/array.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/vector.h>

#define NPY_NO_DEPRECATED_API NPY_1_7_API_VERSION
#include <numpy/arrayobject.h>

#include <algorithm>
#include <optional>
#include <stdexcept>
#include <pinocchio/config.hpp>  // only the version

#include "engine.hpp"

namespace nb = nanobind;
using namespace nb::literals;

namespace pinik {
namespace {

// position (3), rotation (9, row by row), direction (3), at (3), of each target.
constexpr int numbers_of_a_goal = 18;

Goal goal_from(const double* numbers) {
  Goal goal;
  goal.position = Eigen::Map<const Vec3>(numbers);
  goal.rotation = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(numbers + 3);
  goal.direction = Eigen::Map<const Vec3>(numbers + 12);
  goal.at = Eigen::Map<const Vec3>(numbers + 15);
  return goal;
}

std::vector<Goal> goals_from(const double* numbers, std::size_t count) {
  std::vector<Goal> goals;
  for (std::size_t t = 0; t < count; ++t) goals.push_back(goal_from(numbers + numbers_of_a_goal * t));
  return goals;
}

void add_joint(Robot& robot, int kind, int parent, const Mat3& R, const Vec3& p, const Vec3& axis, int idx_q, int nq,
               int idx_v, int nv, bool follows, double multiplier, double offset, double lower, double upper,
               bool shared) {
  Mechanism& mechanism = robot.mechanism;
  Joint joint;
  joint.kind = static_cast<JointKind>(kind);
  joint.parent = parent;
  if (joint.has_one_axis()) joint.to_line = Eigen::Quaterniond::FromTwoVectors(Vec3::UnitZ(), axis).toRotationMatrix();
  const Mat3 from_parent = mechanism.joints.at(static_cast<std::size_t>(parent)).to_line.transpose();
  joint.placement = Placement{from_parent * R * joint.to_line, from_parent * p};
  joint.idx_q = idx_q;
  joint.nq = nq;
  joint.idx_v = idx_v;
  joint.nv = nv;
  joint.follows = follows;
  joint.multiplier = multiplier;
  joint.offset = offset;
  joint.lower = lower;
  joint.upper = upper;
  joint.shared = shared;
  mechanism.nq += nq;
  mechanism.joints.push_back(joint);
}

Placement in_joint(const Robot& robot, int joint, const Mat3& R, const Vec3& p) {
  const Mat3 turned = robot.mechanism.joints.at(static_cast<std::size_t>(joint)).to_line.transpose();
  return {turned * R, turned * p};
}

// The numbers of a plain float64 array of that shape; null where it is anything else.
const double* numbers_of(nb::handle array, std::initializer_list<npy_intp> shape) {
  if (!PyArray_Check(array.ptr())) return nullptr;
  auto* own = reinterpret_cast<PyArrayObject*>(array.ptr());
  const bool fits = PyArray_TYPE(own) == NPY_DOUBLE && PyArray_ISCARRAY_RO(own) &&
                    PyArray_NDIM(own) == static_cast<int>(shape.size()) &&
                    std::equal(shape.begin(), shape.end(), PyArray_DIMS(own));
  return fits ? static_cast<const double*>(PyArray_DATA(own)) : nullptr;
}

nb::object as_array(const Vector& numbers) {
  npy_intp size = numbers.size();
  nb::object array = nb::steal(PyArray_SimpleNew(1, &size, NPY_DOUBLE));
  std::copy_n(numbers.data(), size, static_cast<double*>(PyArray_DATA(reinterpret_cast<PyArrayObject*>(array.ptr()))));
  return array;
}

nb::object as_float(double value) { return std::isnan(value) ? nb::none() : nb::object(nb::float_(value)); }

nb::tuple as_tuple(const std::vector<TargetError>& errors) {
  nb::list list;
  for (const TargetError& error : errors)
    list.append(nb::make_tuple(as_float(error.position), as_float(error.orientation)));
  return nb::tuple(list);
}

nb::tuple as_tuple(const State& state) {
  return nb::make_tuple(as_array(state.q), state.iteration, state.joint_updates, as_tuple(state.errors), state.residual,
                        state.attempt, static_cast<int>(state.status));
}

nb::object proof_of(const Answer& answer) {
  if (!answer.proof) return nb::none();
  return nb::make_tuple(answer.proof->target, answer.proof->distance, answer.proof->bound, answer.proof->inner);
}

nb::tuple states_of(const Answer& answer) {
  nb::list states;
  for (const State& state : answer.states) states.append(as_tuple(state));
  return nb::tuple(states);
}

bool no_signal() {
  const nb::gil_scoped_acquire acquire;
  return PyErr_CheckSignals() == 0;
}

Answer solve(Engine& engine, Vector start, std::vector<Goal> goals, bool nearest) {
  if (start.size() != engine.mechanism().nq || goals.size() != engine.problem().terms.size())
    throw std::invalid_argument("a start or goals of another problem");
  Answer answer;
  {
    const nb::gil_scoped_release release;
    answer = engine.solve(std::move(start), std::move(goals), nearest, &no_signal);
  }
  if (PyErr_Occurred()) throw nb::python_error();
  return answer;
}

nb::object goals_of(const Answer& answer) {
  nb::list rows;
  for (const Goal& goal : answer.goals) {
    Vector row(numbers_of_a_goal);
    const Eigen::Matrix<double, 3, 3, Eigen::RowMajor> R = goal.rotation;
    row << goal.position, Eigen::Map<const Eigen::Matrix<double, 9, 1>>(R.data()), goal.direction, goal.at;
    rows.append(as_array(row));
  }
  return rows;
}

// A rotation to the last bits: what is less needs a better check than this one.
bool is_rotation(const Mat3& R) {
  return (R * R.transpose() - Mat3::Identity()).cwiseAbs().maxCoeff() < 1e-14 && R.determinant() > 0.0;
}

// One target that asks for a position, a rotation or both, by a 4×4 matrix or a position alone; nothing where the
// numbers are not beyond doubt.
std::optional<Goal> goal_from(const Term& term, nb::handle place) {
  constexpr double farthest = 1e9;
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

std::optional<Answer> solve_at(Engine& engine, nb::handle place, nb::handle start, bool nearest) {
  const int nq = engine.mechanism().nq;
  const double* numbers = numbers_of(start, {nq});
  if (engine.problem().terms.size() != 1 || !numbers) return std::nullopt;
  const std::optional<Goal> goal = goal_from(engine.problem().terms.front(), place);
  Vector q = Eigen::Map<const Vector>(numbers, nq);
  if (!goal || !engine.mechanism().normalize(q)) return std::nullopt;
  return solve(engine, std::move(q), {*goal}, nearest);
}

template <class T>
nb::object as_array(std::vector<T>&& values, std::initializer_list<std::size_t> shape) {
  auto* kept = new std::vector<T>(std::move(values));
  const nb::capsule owner(kept, [](void* pointer) noexcept { delete static_cast<std::vector<T>*>(pointer); });
  return nb::cast(nb::ndarray<nb::numpy, T>(kept->data(), shape, owner));
}

// Of each problem: q, status, the largest position and orientation error, iterations, joint updates, restarts, seconds.
nb::tuple solve_many(Engine& engine, nb::ndarray<const double, nb::ndim<2>, nb::c_contig> starts,
                     nb::ndarray<const double, nb::ndim<3>, nb::c_contig> goals, bool nearest, int threads) {
  const std::size_t count = goals.shape(0), terms = goals.shape(1), nq = starts.shape(1);
  const bool one_start = starts.shape(0) == 1;
  const bool fits = nq == static_cast<std::size_t>(engine.mechanism().nq) && terms == engine.problem().terms.size() &&
                    goals.shape(2) == numbers_of_a_goal && (one_start || starts.shape(0) == count);
  if (!fits) throw std::invalid_argument("starts or goals of another problem");
  std::vector<double> q(count * nq), position(count), orientation(count), seconds(count);
  std::vector<int> status(count);
  std::vector<std::int64_t> iterations(count), updates(count), restarts(count);
  bool interrupted = false;
  {
    nb::gil_scoped_release release;
    engine.solve_many(
        count, threads, nearest,
        [&](std::uint64_t i, Vector& start, std::vector<Goal>& wanted) {
          start = Eigen::Map<const Vector>(starts.data() + (one_start ? 0 : i) * nq, static_cast<Eigen::Index>(nq));
          wanted.resize(terms);
          for (std::size_t t = 0; t < terms; ++t)
            wanted[t] = goal_from(goals.data() + numbers_of_a_goal * (i * terms + t));
        },
        [&](std::uint64_t i, const Answer& answer) {
          Eigen::Map<Vector>(q.data() + i * nq, static_cast<Eigen::Index>(nq)) = answer.q;
          TargetError largest;
          for (const TargetError& error : answer.errors) {
            largest.position = std::fmax(largest.position, error.position);
            largest.orientation = std::fmax(largest.orientation, error.orientation);
          }
          position[i] = largest.position;
          orientation[i] = largest.orientation;
          status[i] = static_cast<int>(answer.status);
          iterations[i] = answer.iterations;
          updates[i] = answer.joint_updates;
          restarts[i] = answer.restarts;
          seconds[i] = answer.seconds;
        },
        [&] {
          const nb::gil_scoped_acquire acquire;
          interrupted = interrupted || PyErr_CheckSignals() != 0;
          return !interrupted;
        });
  }
  if (interrupted) throw nb::python_error();
  return nb::make_tuple(as_array(std::move(q), {count, nq}), as_array(std::move(status), {count}),
                        as_array(std::move(position), {count}), as_array(std::move(orientation), {count}),
                        as_array(std::move(iterations), {count}), as_array(std::move(updates), {count}),
                        as_array(std::move(restarts), {count}), as_array(std::move(seconds), {count}));
}

}  // namespace
}  // namespace pinik

NB_MODULE(_native, m) {
  using namespace pinik;
  if (_import_array() < 0) throw nb::python_error();
  m.doc() = "pinik's compiled engine; use it through pinik.solve, engine=\"native\".";
  m.attr("pinocchio_version") = PINOCCHIO_VERSION;

  nb::class_<Robot>(m, "Robot")
      .def(nb::init<>())
      .def("add_joint", &add_joint, "kind"_a, "parent"_a, "rotation"_a, "translation"_a, "axis"_a, "idx_q"_a, "nq"_a,
           "idx_v"_a, "nv"_a, "follows"_a, "multiplier"_a, "offset"_a, "lower"_a, "upper"_a, "shared"_a)
      .def("finish", &Robot::finish);

  nb::class_<Problem>(m, "Problem")
      .def("__init__", [](Problem* self, const Robot& robot) { new (self) Problem(); self->mechanism = &robot.mechanism; },
           nb::keep_alive<1, 2>(), "robot"_a)
      .def("add_term",
           [](Problem& self, const Robot& robot, int frame_joint, const Mat3& frame_R, const Vec3& frame_p,
              bool has_reference, int reference_joint, const Mat3& reference_R, const Vec3& reference_p,
              bool asks_position, bool asks_rotation, bool asks_axis, bool asks_at, const Vec3& axis, double weight,
              bool has_bounds, const Vec3& base, std::array<double, 2> reach, std::array<double, 2> hole) {
             Term term;
             term.frame_joint = frame_joint;
             term.frame = in_joint(robot, frame_joint, frame_R, frame_p);
             term.has_reference = has_reference;
             term.reference_joint = reference_joint;
             term.reference = in_joint(robot, reference_joint, reference_R, reference_p);
             term.asks_position = asks_position;
             term.asks_rotation = asks_rotation;
             term.asks_axis = asks_axis;
             term.asks_at = asks_at;
             term.axis = axis;
             term.weight = weight;
             term.has_bounds = has_bounds;
             term.base = base;
             for (std::size_t k = 0; k < 2; ++k) {
               term.reach[k] = reach[k];
               term.hole[k] = hole[k];
             }
             self.terms.push_back(term);
           },
           "robot"_a, "frame_joint"_a, "frame_rotation"_a, "frame_translation"_a, "has_reference"_a,
           "reference_joint"_a, "reference_rotation"_a, "reference_translation"_a, "asks_position"_a,
           "asks_rotation"_a, "asks_axis"_a, "asks_at"_a, "axis"_a, "weight"_a, "has_bounds"_a, "base"_a, "reach"_a,
           "hole"_a)
      .def("add_coordinate",
           [](Problem& self, int joint, int index, int entry,
              const std::vector<std::pair<int, double>>& movers, const std::vector<std::pair<int, double>>& moved) {
             Coordinate coordinate;
             coordinate.joint = joint;
             coordinate.index = index;
              coordinate.entry = entry;
             for (const auto& [joint, multiplier] : movers) coordinate.movers.push_back({joint, multiplier});
            for (const auto& [joint, multiplier] : moved) coordinate.moved.push_back({joint, multiplier});
             self.coordinates.push_back(coordinate);
           },
           "joint"_a, "index"_a, "entry"_a, "movers"_a, "moved"_a)
      .def("finish",
           [](Problem& self, double lightest, double size_of_chain) {
             self.lightest = lightest;
             self.size_of_chain = size_of_chain;
             self.finish();
           },
           "lightest"_a, "size_of_chain"_a);

  nb::class_<Solver>(m, "Solver")
      .def(nb::init<>())
      .def_prop_rw("method", [](const Solver& s) { return static_cast<int>(s.method); },
                   [](Solver& s, int method) { s.method = static_cast<Method>(method); })
      .def_prop_rw("rule", [](const Solver& s) { return static_cast<int>(s.rule); },
                   [](Solver& s, int rule) { s.rule = static_cast<DampingRule>(rule); })
      .def_rw("max_step", &Solver::max_step)
      .def_rw("max_residual", &Solver::max_residual)
      .def_rw("step_size", &Solver::step_size)
      .def_rw("target_jacobian", &Solver::target_jacobian)
      .def_rw("alpha", &Solver::alpha)
      .def_rw("cutoff", &Solver::cutoff)
      .def_rw("rest_gain", &Solver::rest_gain)
      .def_rw("rest_posture", &Solver::rest_posture)
      .def_rw("damping", &Solver::damping)
      .def_rw("manipulability", &Solver::manipulability)
      .def_rw("by_svd", &Solver::by_svd)
      .def_rw("stiffness", &Solver::stiffness)
      .def_rw("relaxation", &Solver::relaxation)
      .def_rw("position_weight", &Solver::position_weight)
      .def_rw("printed_scaling", &Solver::printed_scaling);

  nb::class_<Settings>(m, "Settings")
      .def(nb::init<>())
      .def_rw("solver", &Settings::solver)
      .def_prop_rw("patience", [](const Settings& s) { return std::make_pair(s.patience.iterations, s.patience.progress); },
                   [](Settings& s, std::pair<int, double> patience) {
                     s.patience = {patience.first, patience.second};
                   })
      .def_prop_rw("tolerance",
                   [](const Settings& s) { return std::make_pair(s.tolerance.position, s.tolerance.orientation); },
                   [](Settings& s, std::pair<double, double> tolerance) {
                     s.tolerance = {tolerance.first, tolerance.second};
                   })
      .def_rw("limits", &Settings::limits)
      .def_rw("restarts", &Settings::restarts)
      .def_rw("seed", &Settings::seed)
      .def_rw("max_iterations", &Settings::max_iterations)
      .def_rw("iterations_to_the_end", &Settings::iterations_to_the_end)
      .def_rw("time_limit", &Settings::time_limit)
      .def_rw("trace", &Settings::trace);

  nb::class_<Answer>(m, "Answer")
      .def_prop_ro("status", [](const Answer& a) { return static_cast<int>(a.status); })
      .def_prop_ro("q", [](const Answer& a) { return as_array(a.q); },
                   nb::sig("def q(self) -> NDArray[numpy.float64]"))
      .def_prop_ro("errors", [](const Answer& a) { return as_tuple(a.errors); },
                   nb::sig("def errors(self) -> tuple[tuple[float | None, float | None], ...]"))
      .def_ro("iterations", &Answer::iterations)
      .def_ro("joint_updates", &Answer::joint_updates)
      .def_ro("restarts", &Answer::restarts)
      .def_ro("seconds", &Answer::seconds)
      .def_prop_ro("goals", &goals_of, nb::sig("def goals(self) -> list[NDArray[numpy.float64]]"))
      .def_prop_ro("proof", &proof_of, nb::sig("def proof(self) -> tuple[int, float, float, bool] | None"))
      .def_prop_ro("states", &states_of,
                   nb::sig("def states(self) -> tuple[tuple[NDArray[numpy.float64], int, int, "
                           "tuple[tuple[float | None, float | None], ...], float, int, int], ...]"));

  nb::class_<Engine>(m, "Engine")
      .def("__init__",
           [](Engine* self, std::shared_ptr<const Robot> robot, const Problem& problem, const Settings& settings) {
             new (self) Engine(std::move(robot), problem, settings);
           },
           "robot"_a, "problem"_a, "settings"_a)
      .def("solve",
           [](Engine& self, Vector start, nb::ndarray<const double, nb::shape<-1, 18>, nb::c_contig> goals,
              bool nearest) { return solve(self, std::move(start), goals_from(goals.data(), goals.shape(0)), nearest); },
           "start"_a, "goals"_a, "nearest"_a)
      .def("solve_at", &solve_at, "place"_a.none(), "start"_a.none(), "nearest"_a,
           nb::sig("def solve_at(self, place: object, start: object, nearest: bool) -> Answer | None"))
      .def("solve_many", &solve_many, "starts"_a, "goals"_a, "nearest"_a, "threads"_a,
           nb::sig("def solve_many(self, starts: NDArray[numpy.float64], goals: NDArray[numpy.float64], "
                   "nearest: bool, threads: int) -> tuple[NDArray[numpy.float64], NDArray[numpy.int32], "
                   "NDArray[numpy.float64], NDArray[numpy.float64], NDArray[numpy.int64], NDArray[numpy.int64], "
                   "NDArray[numpy.int64], NDArray[numpy.float64]]"));
}

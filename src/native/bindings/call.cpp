#include "call.hpp"

#include "interface.hpp"
#include "recall.hpp"

namespace pinik {

using namespace nb::literals;

namespace {

int traverse_call(PyObject* self, visitproc visit, void* arg) {
  Py_VISIT(Py_TYPE(self));
  return nb::inst_ready(self) ? nb::inst_ptr<Call>(self)->traverse(visit, arg) : 0;
}

int clear_call(PyObject* self) {
  nb::inst_ptr<Call>(self)->clear();
  return 0;
}

PyType_Slot slots[] = {{Py_tp_traverse, reinterpret_cast<void*>(traverse_call)},
                       {Py_tp_clear, reinterpret_cast<void*>(clear_call)},
                       {0, nullptr}};

// An interned name, which lives as long as the interpreter.
PyObject* name(const char* text) {
  PyObject* interned = PyUnicode_InternFromString(text);
  if (!interned) throw nb::python_error();
  return interned;
}

}  // namespace

nb::object Call::solve(nb::handle place, nb::handle start) const {
  bool nearest = false;
  if (start.is_none()) {
    start = neutral_;
  } else if (PyUnicode_CheckExact(start.ptr())) {
    if (PyUnicode_CompareWithASCIIString(start.ptr(), "nearest") != 0) return nb::none();
    start = neutral_;
    nearest = true;
  }
  nb::object matrix;
  if (PyObject_TypeCheck(place.ptr(), reinterpret_cast<PyTypeObject*>(placement_.ptr()))) {
    static PyObject* const homogeneous = name("homogeneous");
    matrix = nb::steal(PyObject_GetAttr(place.ptr(), homogeneous));
    if (!matrix.is_valid()) throw nb::python_error();
    place = matrix;
  }
  std::optional<Answer> answer = solve_at(*nb::inst_ptr<Engine>(engine_), place, start, nearest);
  return answer ? made_from(std::move(*answer)) : nb::none();
}

// What `Solution(answer, question)` does, without the detour through Python.
nb::object Call::made_from(Answer&& answer) const {
  static PyObject* const came_to = name("_came_to");
  static PyObject* const asked = name("_question");
  static PyObject* const no_arguments = PyTuple_New(0);
  auto* type = reinterpret_cast<PyTypeObject*>(solution_.ptr());
  const nb::object solution = nb::steal(type->tp_new(type, no_arguments, nullptr));
  const nb::object outcome = nb::cast(std::move(answer));
  if (!solution.is_valid() || PyObject_SetAttr(solution.ptr(), came_to, outcome.ptr()) < 0 ||
      PyObject_SetAttr(solution.ptr(), asked, question_.ptr()) < 0)
    throw nb::python_error();
  return solution;
}

int Call::traverse(visitproc visit, void* arg) const {
  for (const nb::object* held : {&engine_, &neutral_, &placement_, &solution_, &question_}) Py_VISIT(held->ptr());
  return 0;
}

void Call::clear() {
  for (nb::object* held : {&engine_, &neutral_, &placement_, &solution_, &question_}) held->reset();
}

void register_calls(nb::module_& m) {
  nb::class_<Call>(m, "Call", nb::type_slots(slots), nb::is_weak_referenceable())
      .def(nb::init<nb::typed<nb::object, Engine>, nb::object, nb::type_object, nb::type_object, nb::object>(),
           "engine"_a, "neutral"_a, "placement"_a, "solution"_a, "question"_a)
      .def("solve", &Call::solve, "place"_a.none(), "start"_a.none(),
           nb::sig("def solve(self, place: object, start: object) -> typing.Any"));
  m.def("note", &note, "call"_a, nb::sig("def note(call: Call) -> None"));
  m.def("recalling", &recalling, "function"_a, "place"_a, "methods"_a,
        nb::sig("def recalling(function: typing.Any, place: int, methods: dict[str, typing.Any]) -> typing.Any"));
}

}  // namespace pinik

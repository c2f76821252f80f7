#include "recall.hpp"

#include <structmember.h>

#include <cstddef>
#include <exception>
#include <memory>
#include <new>
#include <vector>

#include "call.hpp"
#include "numbers.hpp"

namespace pinik {

namespace {

// The last call of a thread. Only objects that never change are compared by identity; the robot is only compared while
// the Call exists, which keeps it alive.
struct Last {
  PyObject* function = nullptr;
  PyObject* robot = nullptr;
  nb::object names;
  std::vector<nb::object> values;  // of the arguments; null for the robot, the place and the start
  std::vector<nb::object> methods;
  nb::object call;  // a weak reference
  nb::object noted;  // the Call that has answered the present call
};

// Owned by the thread's dictionary, so that Python frees it when the thread ends.
thread_local Last* of_this_thread = nullptr;

Last* last() {
  if (of_this_thread) return of_this_thread;
  PyObject* own = PyThreadState_GetDict();
  if (!own) return nullptr;
  auto made = std::make_unique<Last>();
  const nb::object capsule = nb::steal(PyCapsule_New(made.get(), "pinik.last", [](PyObject* capsule) {
    auto* freed = static_cast<Last*>(PyCapsule_GetPointer(capsule, "pinik.last"));
    if (of_this_thread == freed) of_this_thread = nullptr;
    delete freed;
  }));
  if (!capsule.is_valid() || PyDict_SetItemString(own, "pinik.last", capsule.ptr()) < 0) {
    PyErr_Clear();
    return nullptr;
  }
  return of_this_thread = made.release();
}

struct Recalling {
  PyObject_HEAD
  vectorcallfunc call;
  PyObject* function;
  PyObject* methods;
  int place;
};

enum class Role { robot, place, point, start, other };

// The names of arguments whose values may differ from call to call, interned.
struct Names {
  PyObject* position = PyUnicode_InternFromString("position");
  PyObject* placement = PyUnicode_InternFromString("placement");
  PyObject* start = PyUnicode_InternFromString("q0");
};

Role role_of(const Recalling& self, Py_ssize_t index, Py_ssize_t positional, PyObject* names) {
  static const Names known;
  if (index == 0) return Role::robot;
  if (index < positional) return index == self.place ? Role::point : Role::other;
  PyObject* name = PyTuple_GET_ITEM(names, index - positional);
  if (name == known.position) return Role::point;
  if (name == known.placement) return Role::place;
  return name == known.start ? Role::start : Role::other;
}

// Whether identity means equality, now and later.
bool never_changes(PyObject* value) {
  return value == Py_None || PyBool_Check(value) || PyLong_CheckExact(value) || PyFloat_CheckExact(value) ||
         PyUnicode_CheckExact(value) || (PyTuple_CheckExact(value) && PyTuple_GET_SIZE(value) == 0);
}

// Whether two tuples of names, or null, hold the same ones; the names of arguments are interned.
bool same_names(PyObject* a, PyObject* b) {
  if (a == b) return true;
  if (!a || !b || PyTuple_GET_SIZE(a) != PyTuple_GET_SIZE(b)) return false;
  for (Py_ssize_t i = 0; i < PyTuple_GET_SIZE(a); ++i)
    if (PyTuple_GET_ITEM(a, i) != PyTuple_GET_ITEM(b, i)) return false;
  return true;
}

// Whether the names of methods mean what they meant in the last call.
bool same_methods(const Last& last, PyObject* methods) {
  if (static_cast<std::size_t>(PyDict_GET_SIZE(methods)) * 2 != last.methods.size()) return false;
  PyObject *name, *meant;
  Py_ssize_t at = 0;
  for (std::size_t i = 0; PyDict_Next(methods, &at, &name, &meant); i += 2)
    if (last.methods[i].ptr() != name || last.methods[i + 1].ptr() != meant) return false;
  return true;
}

nb::object recalled(const Recalling& self, const Last& last, PyObject* const* args, Py_ssize_t positional,
                    PyObject* names) {
  const Py_ssize_t count = positional + (names ? PyTuple_GET_SIZE(names) : 0);
  if (last.function != reinterpret_cast<const PyObject*>(&self) || !same_names(last.names.ptr(), names) ||
      static_cast<Py_ssize_t>(last.values.size()) != count || args[0] != last.robot)
    return nb::none();
  PyObject* call = PyWeakref_GET_OBJECT(last.call.ptr());
  if (call == Py_None || !same_methods(last, self.methods)) return nb::none();
  PyObject *place = nullptr, *start = Py_None;
  for (Py_ssize_t i = 1; i < count; ++i) {
    if (PyObject* own = last.values[static_cast<std::size_t>(i)].ptr()) {
      if (own != args[i]) return nb::none();
      continue;
    }
    const Role role = role_of(self, i, positional, names);
    (role == Role::start ? start : place) = args[i];
    if (role == Role::point && !numbers_of(args[i], {3})) return nb::none();
  }
  const nb::object alive = nb::borrow(call);
  return nb::inst_ptr<Call>(alive)->solve(place, start);
}

// Remember a call that `noted` has answered, if it can be recalled.
void remember(const Recalling& self, Last& last, PyObject* const* args, Py_ssize_t positional, PyObject* names) {
  const Py_ssize_t count = positional + (names ? PyTuple_GET_SIZE(names) : 0);
  std::vector<nb::object> values(static_cast<std::size_t>(count));
  int places = 0;
  for (Py_ssize_t i = 1; i < count; ++i) {
    const Role role = role_of(self, i, positional, names);
    places += role == Role::place || role == Role::point;
    if (role != Role::other) continue;
    if (!never_changes(args[i])) return;
    values[static_cast<std::size_t>(i)] = nb::borrow(args[i]);
  }
  if (places != 1) return;
  last.methods.clear();
  PyObject *name, *meant;
  for (Py_ssize_t at = 0; PyDict_Next(self.methods, &at, &name, &meant);) {
    last.methods.push_back(nb::borrow(name));
    last.methods.push_back(nb::borrow(meant));
  }
  last.call = nb::steal(PyWeakref_NewRef(last.noted.ptr(), nullptr));
  if (!last.call.is_valid()) {
    PyErr_Clear();
    return;
  }
  last.names = nb::borrow(names);
  last.values = std::move(values);
  last.robot = args[0];
  last.function = reinterpret_cast<PyObject*>(const_cast<Recalling*>(&self));
}

PyObject* vectorcall(PyObject* self_object, PyObject* const* args, std::size_t flags, PyObject* names) {
  const auto& self = *reinterpret_cast<Recalling*>(self_object);
  const Py_ssize_t positional = PyVectorcall_NARGS(flags);
  try {
    Last* own = last();
    if (own && positional > 0 && own->function) {
      nb::object solution = recalled(self, *own, args, positional, names);
      if (!solution.is_none()) return solution.release().ptr();
    }
    if (own) {
      own->function = nullptr;
      own->noted.reset();
    }
    PyObject* result = PyObject_Vectorcall(self.function, args, flags, names);
    if (own && result && positional > 0 && own->noted.is_valid()) remember(self, *own, args, positional, names);
    if (own) own->noted.reset();
    return result;
  } catch (nb::python_error& error) {
    error.restore();
  } catch (const std::bad_alloc&) {
    PyErr_NoMemory();
  } catch (const std::exception& error) {
    PyErr_SetString(PyExc_RuntimeError, error.what());
  }
  return nullptr;
}

PyObject* bind(PyObject* self, PyObject* instance, PyObject*) {
  return instance && instance != Py_None ? PyMethod_New(self, instance) : Py_NewRef(self);
}

// Everything else, such as the documentation, is the function's.
PyObject* attribute(PyObject* self, PyObject* name) {
  PyObject* function = reinterpret_cast<Recalling*>(self)->function;
  if (PyUnicode_CompareWithASCIIString(name, "__wrapped__") == 0) return Py_NewRef(function);
  if (PyUnicode_CompareWithASCIIString(name, "__class__") == 0 ||
      PyUnicode_CompareWithASCIIString(name, "__reduce__") == 0 ||
      PyUnicode_CompareWithASCIIString(name, "__reduce_ex__") == 0)
    return PyObject_GenericGetAttr(self, name);
  return PyObject_GetAttr(function, name);
}

// Pickled and copied by name, as functions are.
PyObject* reduce(PyObject* self, PyObject*) {
  return PyObject_GetAttrString(reinterpret_cast<Recalling*>(self)->function, "__qualname__");
}

PyObject* text(PyObject* self) { return PyObject_Repr(reinterpret_cast<Recalling*>(self)->function); }

int traverse(PyObject* self, visitproc visit, void* arg) {
  Py_VISIT(Py_TYPE(self));
  Py_VISIT(reinterpret_cast<Recalling*>(self)->function);
  Py_VISIT(reinterpret_cast<Recalling*>(self)->methods);
  return 0;
}

int clear(PyObject* self) {
  Py_CLEAR(reinterpret_cast<Recalling*>(self)->function);
  Py_CLEAR(reinterpret_cast<Recalling*>(self)->methods);
  return 0;
}

void destroy(PyObject* self) {
  PyTypeObject* type = Py_TYPE(self);
  PyObject_GC_UnTrack(self);
  clear(self);
  PyObject_GC_Del(self);
  Py_DECREF(type);
}

PyObject* make_type() {
  static PyMemberDef members[] = {
      {"__vectorcalloffset__", T_PYSSIZET, offsetof(Recalling, call), READONLY, nullptr}, {}};
  static PyMethodDef methods[] = {{"__reduce__", reduce, METH_NOARGS, nullptr}, {}};
  static PyType_Slot slots[] = {{Py_tp_call, reinterpret_cast<void*>(PyVectorcall_Call)},
                                {Py_tp_members, members},
                                {Py_tp_methods, methods},
                                {Py_tp_descr_get, reinterpret_cast<void*>(bind)},
                                {Py_tp_getattro, reinterpret_cast<void*>(attribute)},
                                {Py_tp_repr, reinterpret_cast<void*>(text)},
                                {Py_tp_traverse, reinterpret_cast<void*>(traverse)},
                                {Py_tp_clear, reinterpret_cast<void*>(clear)},
                                {Py_tp_dealloc, reinterpret_cast<void*>(destroy)},
                                {0, nullptr}};
  static PyType_Spec spec = {"pinik._native.Recalling", sizeof(Recalling), 0,
                             Py_TPFLAGS_DEFAULT | Py_TPFLAGS_HAVE_GC | Py_TPFLAGS_HAVE_VECTORCALL |
                                 Py_TPFLAGS_METHOD_DESCRIPTOR | Py_TPFLAGS_DISALLOW_INSTANTIATION,
                             slots};
  PyObject* type = PyType_FromSpec(&spec);
  if (!type) throw nb::python_error();
  return type;
}

}  // namespace

void note(nb::handle call) {
  if (Last* own = last()) own->noted = nb::borrow(call);
}

nb::object recalling(nb::handle function, int place, nb::dict methods) {
  static PyObject* const type = make_type();
  auto* self = PyObject_GC_New(Recalling, reinterpret_cast<PyTypeObject*>(type));
  if (!self) throw nb::python_error();
  self->call = vectorcall;
  self->function = Py_NewRef(function.ptr());
  self->methods = Py_NewRef(methods.ptr());
  self->place = place;
  PyObject_GC_Track(reinterpret_cast<PyObject*>(self));
  return nb::steal(reinterpret_cast<PyObject*>(self));
}

}  // namespace pinik

from __future__ import annotations

import dataclasses
import math
import pickle
from dataclasses import dataclass

import numpy as np
import pytest

import pinik
from pinik.solvers.parameter import parameters_of
from pinik.solvers.registry import make_solver


@pytest.mark.parametrize("name", ["ccd", "jt", "pinv", "dls"])
def test_a_name_a_class_and_an_instance_mean_the_same(name):
    solver_class = pinik.SOLVERS[name]
    assert make_solver(name) == make_solver(solver_class) == make_solver(solver_class()) == solver_class()
    assert make_solver(name, max_step=0.25).max_step == 0.25
    assert make_solver(solver_class(max_step=0.5), max_residual=0.1).parameters | {} == (
        solver_class(max_step=0.5, max_residual=0.1).parameters
    )


def test_a_class_is_found_by_module_and_name():
    assert type(make_solver("pinik.solvers.ccd:CCD")) is pinik.CCD
    with pytest.raises(pinik.UnknownNameError, match="could not import it"):
        make_solver("no_such_module:Solver")


def test_wrong_names_list_the_right_ones():
    with pytest.raises(pinik.UnknownNameError, match="'dls'"):
        make_solver("dlss")
    with pytest.raises(pinik.UnknownNameError, match="'damping'"):
        make_solver("dls", dampin=1.0)
    with pytest.raises(pinik.InputError, match="Solver class or an instance"):
        make_solver(3)


@pytest.mark.parametrize(
    "method", [pinik.Solver, pinik.JacobianSolver, pinik.SweepingSolver, pinik.Solver(), ":x", "..a:x"]
)
def test_what_is_no_whole_solver_is_refused(method, arm):
    with pytest.raises(pinik.PinikError):
        arm.solve("tip", position=[0, 0, 1], method=method)


def test_a_solver_whose_class_lacks_its_decorator_is_told_so(arm):
    class Bare(pinik.JacobianSolver):
        gain: float = pinik.parameter(0.5, "factor")

        def direction(self, J, e):
            return self.gain * J.T @ e

    with pytest.raises(pinik.InputError, match="Bare: the class must be decorated with @dataclass"):
        arm.solve("tip", position=[0, 0, 1], method=Bare)


def test_a_plain_field_and_no_name_are_enough(arm):
    @dataclass(frozen=True, kw_only=True)
    class Plain(pinik.JacobianSolver):
        rounds: int = pinik.parameter(3, "a whole number", low=1)
        gain: float = 0.5

        def direction(self, J, e):
            return self.gain * J.T @ e

    assert arm.solve("tip", position=[0.1, 0.1, 1.2], method=Plain).method == "Plain"
    assert type(Plain(rounds=4).rounds) is int


@pytest.mark.parametrize("step", [np.zeros((12, 1)), np.zeros(3), None, 1.0])
def test_a_direction_of_the_wrong_shape_is_refused_in_words(step, arm):
    @dataclass(frozen=True, kw_only=True)
    class Wrong(pinik.JacobianSolver):
        def direction(self, J, e):
            return step

    with pytest.raises(pinik.InputError, match=r"Wrong.direction must return dq of shape \(12,\)"):
        arm.solve("tip", position=[0, 0, 1], method=Wrong)


def test_a_rest_posture_of_a_joint_without_an_angle_is_refused():
    robot = pinik.load("arm", root="free_flyer")
    with pytest.raises(pinik.InputError, match="'root_joint' must have one axis; it is floating"):
        robot.solve("tip", position=[2, 0, 1], method="pinv", rest_posture={"root_joint": 2.0})


@pytest.mark.parametrize("name", ["ccd", "jt", "pinv", "dls"])
def test_solvers_are_immutable_and_travel_to_other_processes(name):
    solver = make_solver(name, max_step=0.3)
    with pytest.raises(AttributeError):
        solver.max_step = 1.0
    with pytest.raises(TypeError):
        solver.stiffness["j"] = -3.0
    again = pickle.loads(pickle.dumps(solver))
    assert again == solver
    assert hash(again) == hash(solver)


@pytest.mark.parametrize("name", ["ccd", "jt", "pinv", "dls"])
def test_every_parameter_says_what_it_is(name):
    described = {own.name: own for own in parameters_of(pinik.SOLVERS[name])}
    assert list(described) == [field.name for field in dataclasses.fields(pinik.SOLVERS[name])]
    assert all(own.help for own in described.values())


def test_none_stands_for_no_bound_where_json_has_no_infinity():
    assert pinik.PseudoInverse(max_step=None).max_step == math.inf
    assert pinik.CCD(max_residual=None) == pinik.CCD()


@pytest.mark.parametrize("value", [math.inf, 10**400, "1", None, True, [1.0]])
def test_a_damping_that_is_no_finite_number_is_refused(value):
    with pytest.raises(pinik.InputError, match="dls: damping must be a finite number from"):
        pinik.DampedLeastSquares(damping=value)


def test_a_stiffness_outside_zero_to_one_or_of_an_unknown_joint_is_refused(arm):
    with pytest.raises(pinik.InputError, match=r"stiffness\['bone1_x'\]"):
        pinik.CCD(stiffness={"bone1_x": 1.5})
    with pytest.raises(pinik.UnknownNameError, match="bone1_x"):
        arm.solve("tip", position=[0, 0, 1], method="ccd", stiffness={"bone1_q": 0.5})


@pytest.mark.parametrize("given", ["no_such_module:Solver", "no_such_method", "a:b:c"])
def test_an_unknown_method_is_told_by_kind_and_name(given):
    with pytest.raises(pinik.UnknownNameError) as caught:
        make_solver(given)
    assert (caught.value.kind, caught.value.name) == ("method", given)
    assert {"ccd", "jt", "pinv", "dls", "two_bone"} <= set(caught.value.valid)


def test_an_unknown_parameter_is_told_by_kind_and_method():
    with pytest.raises(pinik.UnknownNameError, match="the method is 'dls'") as caught:
        make_solver("dls", damp=1.0)
    assert (caught.value.kind, caught.value.name) == ("parameter", "damp")


def test_a_set_of_joint_values_equals_mappings_only_and_shows_them():
    values = pinik.CCD(stiffness={"a": 0.5}).stiffness
    assert values == {"a": 0.5}
    assert values != 5
    assert values != {"a": 0.25}
    assert repr(values) == "{'a': 0.5}"

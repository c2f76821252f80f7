"""The compiled engine: its stub, when it is not there, threads, time, and answers checked by plain Pinocchio."""

from __future__ import annotations

import ast
import hashlib
import os
import subprocess
import sys
import threading
import time
from dataclasses import dataclass
from pathlib import Path

import coal
import numpy as np
import pinocchio
import pytest

import pinik
from engines import REQUIRED, SANITIZED, WHY_NOT, needs_native
from judge import assert_honest, plain_placement
from pinik import Status, Target, engine
from pinik.solvers.parameter import parameters_of
from pinik.solving.native import codec, constants, module

METHODS = ["ccd", "jt", "pinv", "dls"]
STUB = Path(pinik.__file__).with_name("_native.pyi")


@pytest.fixture
def reload_engine():
    """`module` looks for the module anew in this test and after it."""
    engine.load.cache_clear()
    yield
    engine.load.cache_clear()


@pytest.fixture
def no_module(monkeypatch, reload_engine):
    monkeypatch.setitem(sys.modules, "pinik._native", None)
    monkeypatch.delattr(pinik, "_native", raising=False)


@pytest.fixture
def another_pinocchio(monkeypatch, reload_engine):
    monkeypatch.setattr(pinocchio, "__version__", "99.1.0")


def test_the_engine_is_there_where_it_is_required():
    """With PINIK_REQUIRE_NATIVE set nothing is skipped for want of an engine."""
    if REQUIRED:
        assert WHY_NOT is None
    program = (
        "import sys; sys.modules['pinik._native'] = None\n"
        "import engines; print(engines.WHY_NOT is not None, engines.needs_native.args[0])"
    )
    for required, printed in (("", "True True"), ("1", "True False")):
        path = os.pathsep.join(map(str, (Path(__file__).parents[1], Path(pinik.__file__).parents[1])))
        environment = os.environ | {"PINIK_REQUIRE_NATIVE": required, "PYTHONPATH": path}
        done = subprocess.run(
            [sys.executable, "-c", program], env=environment, capture_output=True, text=True, check=True
        )
        assert done.stdout.strip() == printed


@needs_native
def test_the_stub_is_what_nanobind_writes_for_the_module():
    from nanobind.stubgen import StubGen

    from pinik import _native

    generator = StubGen(_native)
    generator.put(_native)
    assert shape_of(STUB.read_text()) == shape_of(generator.get())


def test_package_and_module_hold_the_digest_of_the_stub():
    """So that a change of signatures changes it, and the module of an earlier build is told apart."""
    lines = [line for line in STUB.read_text().splitlines() if not line.startswith("abi:")]
    digest = hashlib.sha256("\n".join(lines).encode()).hexdigest()[:16]
    assert digest == engine.ABI
    assert f'abi: str = "{digest}"' in STUB.read_text()
    if WHY_NOT is None:
        from pinik import _native

        assert digest == _native.abi


def shape_of(stub: str) -> str:
    """A stub without docstrings and formatting."""
    tree = ast.parse(stub)
    for node in ast.walk(tree):
        body = getattr(node, "body", None)
        if isinstance(body, list) and body and isinstance(body[0], ast.Expr):
            value = body[0].value
            if isinstance(value, ast.Constant) and isinstance(value.value, str):
                body[0] = ast.Expr(ast.Constant(...))
                if len(body) > 1:
                    del body[0]
    return ast.dump(tree, indent=1)


def test_without_the_module_python_computes_and_says_why(no_module, panda):
    assert "not built" in module.why_not()
    s = panda.solve("panda_hand_tcp", [0.4, 0.1, 0.5], seed=101)
    assert s.success
    assert s.engine == "python"
    with pytest.raises(pinik.EngineError, match=r"cannot be used: it was not built.*engine='auto' or 'python'"):
        panda.solve("panda_hand_tcp", [0.4, 0.1, 0.5], engine="native", seed=102)


@needs_native
def test_an_engine_for_another_pinocchio_refuses(another_pinocchio, panda):
    built = pinocchio_of_the_module()
    assert module.why_not() == (f"it was built against Pinocchio {built}, and 99.1.0 is installed; install pinik again")
    assert panda.solve("panda_hand_tcp", [0.4, 0.1, 0.5], seed=103).engine == "python"
    with pytest.raises(pinik.EngineError, match=r"99\.1\.0 is installed"):
        panda.solve("panda_hand_tcp", [0.4, 0.1, 0.5], engine="native", seed=104)


@needs_native
def test_an_engine_for_another_coal_refuses(monkeypatch, reload_engine, panda):
    from pinik import _native

    monkeypatch.setattr(coal, "__version__", "9.9.9")
    assert f"built against coal {_native.coal_version}, and 9.9.9 is installed" in module.why_not()
    assert panda.solve("panda_hand_tcp", [0.4, 0.1, 0.5], seed=107).engine == "python"


@needs_native
@pytest.mark.parametrize("abi", ["that of an earlier build", None])
def test_an_engine_of_another_build_refuses(monkeypatch, reload_engine, panda, abi):
    from pinik import _native

    if abi is None:
        monkeypatch.delattr(_native, "abi")
    else:
        monkeypatch.setattr(_native, "abi", abi)
    with pytest.warns(RuntimeWarning, match="tens of times slower: the compiled module belongs to another build"):
        assert module.why_not() == "the compiled module belongs to another build of pinik; install pinik again"
    assert panda.solve("panda_hand_tcp", [0.4, 0.1, 0.5], seed=105).engine == "python"
    with pytest.raises(pinik.EngineError, match="another build of pinik; install pinik again"):
        panda.solve("panda_hand_tcp", [0.4, 0.1, 0.5], engine="native", seed=106)


@needs_native
def test_the_engine_knows_every_method_rule_kind_and_status_by_its_name():
    from pinik import _native

    def names(enumeration):
        return {member.name for member in enumeration}

    rule = next(p for p in parameters_of(pinik.DampedLeastSquares) if p.name == "rule")
    assert names(_native.Method) == set(METHODS) == {solver.name for solver in module.METHODS}
    assert names(_native.DampingRule) == set(rule.choices)
    assert names(_native.JointKind) == {"revolute", "continuous", "prismatic", "floating", "planar"}
    assert names(_native.Status) == {status.name for status in Status} | {"RUNNING"}


@needs_native
def test_every_constant_of_the_engine_is_handed_over():
    from pinik import _native

    theirs = {name for name in vars(_native.Constants) if not name.startswith("_")}
    assert theirs == {*constants.CONSTANTS, *constants.PATIENCES}
    made = constants.make_constants()
    assert {name: getattr(made, name) for name in constants.CONSTANTS} == constants.CONSTANTS


@needs_native
def test_the_engine_computes_with_the_constants_that_it_is_given(monkeypatch, panda):
    def restarts(seed):
        return panda.solve("panda_hand_tcp", [3.0, 0.0, 0.5], engine="native", seed=seed).restarts

    assert restarts(107) == constants.CONSTANTS["restarts_when_unreachable"]
    monkeypatch.setitem(constants.CONSTANTS, "restarts_when_unreachable", 3)
    assert restarts(108) == 3


@needs_native
@pytest.mark.parametrize("most", [2**31 - 1, 2**31, 2**63, 10**30])
def test_any_number_of_restarts_and_iterations_is_taken(most, panda):
    opposed = [Target("panda_hand_tcp", [0.4, y, 0.5]) for y in (-0.2, 0.2)]
    for q0 in (None, "nearest"):
        prepared = pinik.prepare(panda, opposed, restarts=most, max_iterations=most, time_limit=0.05, engine="native")
        assert prepared(opposed, q0).status is Status.TIME_LIMIT


@needs_native
@pytest.mark.parametrize("name", ["restarts", "max_iterations", "iterations_to_the_end"])
def test_the_engine_counts_in_64_bits(name):
    from pinik import _native

    settings = _native.Settings()
    setattr(settings, name, 2**62)
    assert getattr(settings, name) == 2**62


def pinocchio_of_the_module() -> str:
    from pinik import _native

    return _native.pinocchio_version


@dataclass(frozen=True, kw_only=True)
class Marquardt(pinik.JacobianSolver):
    """A user's own, as CONTRIBUTING.md has it."""

    name = "marquardt"
    damping: float = pinik.parameter(0.01, "μ", low=1e-9)

    def direction(self, J, e):
        A = J.T @ J
        return np.linalg.solve(A + self.damping * np.diag(A.diagonal() + 1e-9), J.T @ e)


@dataclass(frozen=True, kw_only=True)
class Halved(pinik.DampedLeastSquares):
    """Derived from one that is compiled; its own step must not be passed over."""

    name = "halved"

    def direction(self, J, e, residual=None):
        return 0.5 * super().direction(J, e, residual)


@pytest.mark.parametrize("method", [Marquardt, Marquardt(damping=0.1), Halved])
def test_a_users_own_method_runs_in_python(method, panda):
    s = panda.solve("panda_hand_tcp", [0.4, 0.1, 0.5], method=method)
    assert s.success
    assert s.engine == "python"
    with pytest.raises(pinik.EngineError, match=r"the method '(marquardt|halved)' is written in Python|not built"):
        panda.solve("panda_hand_tcp", [0.4, 0.1, 0.5], method=method, engine="native")


@needs_native
def test_auto_takes_the_compiled_engine_for_the_four_methods(panda):
    for method in METHODS:
        assert panda.solve("panda_hand_tcp", [0.4, 0.1, 0.5], method=method).engine == "native"
        assert panda.solve("panda_hand_tcp", [0.4, 0.1, 0.5], method=method, engine="python").engine == "python"


@needs_native
@pytest.mark.parametrize("method", METHODS)
def test_a_success_is_one_by_plain_pinocchio(method, panda, arm, kinova, tiago):
    """Every answer's errors, verdict and limits, judged by Pinocchio alone."""
    rng = np.random.default_rng(5)
    solved = 0
    hands = ("panda_hand_tcp", "tip", "j2s6s200_end_effector", "arm_tool_link")
    for robot, frame in zip((panda, arm, kinova, tiago), hands, strict=True):
        for _ in range(19):
            wanted = plain_placement(robot, frame, robot.random(rng))
            wanted.translation = wanted.translation + rng.choice([0.0, 0.0, 0.5]) * rng.normal(size=3)
            s = robot.solve(frame, placement=wanted, method=method, engine="native", restarts=8, q0=robot.random(rng))
            assert_honest(s, {"frame": frame, "placement": wanted})
            solved += s.success
    assert solved > 30


@needs_native
def test_threads_get_the_answers_that_they_get_alone(panda):
    rng = np.random.default_rng(8)
    asked = [(panda.placement("panda_hand_tcp", panda.random(rng)), panda.random(rng)) for _ in range(60)]

    def answers():
        return [panda.solve("panda_hand_tcp", placement=M, q0=q0, engine="native").q for M, q0 in asked]

    alone, together = answers(), {}
    shared = pinik.prepare(panda, Target("panda_hand_tcp", placement=np.eye(4)), engine="native").native
    goals = [codec.goals_of((Target("panda_hand_tcp", placement=M),)) for M, _ in asked]

    def work(k):
        mine = answers()
        directly = [shared.solve(q0, goal, False).q for goal, (_, q0) in zip(goals, asked, strict=True)]
        together[k] = mine, directly

    threads = [threading.Thread(target=work, args=(k,)) for k in range(8)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert sorted(together) == list(range(8))
    for mine, directly in together.values():
        np.testing.assert_array_equal(mine, alone)
        np.testing.assert_array_equal(directly, alone)


@needs_native
@pytest.mark.parametrize("method", METHODS)
def test_the_interpreter_runs_on_during_a_long_solve(method, panda):
    """A thread that counts gets its turns; with the interpreter's lock held it would get none."""
    opposed = [Target("panda_hand_tcp", [0.4, y, 0.5]) for y in (-0.2, 0.2)]
    counted, running = 0, threading.Event()
    running.set()

    def count():
        nonlocal counted
        while running.is_set():
            counted += 1
            time.sleep(1e-3)

    thread = threading.Thread(target=count)
    thread.start()
    try:
        for _ in range(20):  # a busy machine may give the thread no turn for a while
            before = counted
            s = pinik.solve(panda, opposed, method, engine="native", restarts=10**6, time_limit=0.2)
            during = counted - before
            if during > 20:
                break
    finally:
        running.clear()
        thread.join()
    assert s.status is Status.TIME_LIMIT
    assert during > 20


@needs_native
@pytest.mark.parametrize("method", METHODS)
def test_the_time_limit_ends_a_hopeless_solve(method, panda, lion):
    for robot, frame in ((panda, "panda_hand_tcp"), (lion, "nose")):
        opposed = [Target(frame, [0.4, y, 0.5]) for y in (-0.2, 0.2)]
        began = time.thread_time()  # processor time does not pass while other processes run
        s = pinik.solve(robot, opposed, method, engine="native", restarts=10**9, time_limit=0.1)
        assert time.thread_time() - began < 0.3
        assert s.status is Status.TIME_LIMIT
        assert s.message.startswith("out of time")
        assert s.time >= 0.1


needs_a_limit_of_memory = pytest.mark.skipif(
    not sys.platform.startswith("linux") or SANITIZED is not None,
    reason="needs Linux, where a process can limit its memory; sanitizers need more than any limit",
)


@needs_native
@needs_a_limit_of_memory
def test_more_threads_than_the_system_gives_do_the_work_all_the_same():
    code = (
        "import resource, numpy as np, pinik\n"
        "panda = pinik.load('panda')\n"
        "places = np.tile([0.4, 0.1, 0.5], (3000, 1))\n"
        "pinik.solve_many(panda, 'panda_hand_tcp', places[:2])\n"
        "used = int(open('/proc/self/statm').read().split()[0]) * resource.getpagesize()\n"
        "resource.setrlimit(resource.RLIMIT_AS, (used + 5 * 2**28,) * 2)\n"
        "print(pinik.solve_many(panda, 'panda_hand_tcp', places, threads=1000).success.all())"
    )
    largest = 'ulimit -s 524288 2>/dev/null || ulimit -s "$(ulimit -H -s)"'  # where 512 MB are not allowed
    large_stacks = ["sh", "-c", f'{largest}; exec "$0" -W ignore -c "$1"', sys.executable, code]
    done = subprocess.run(large_stacks, capture_output=True, text=True, check=False)
    assert done.stdout.split() == ["True"], done.stderr


LITTLE_MEMORY = """
import os, resource
import numpy as np, pinik

panda = pinik.load("panda")
places = np.tile([0.4, 0.1, 0.5], (2000, 1))
pinik.solve_many(panda, "panda_hand_tcp", places[:2])
for megabytes in range(2, 130, 4):
    child = os.fork()
    if child == 0:
        used = int(open("/proc/self/statm").read().split()[0]) * resource.getpagesize()
        resource.setrlimit(resource.RLIMIT_AS, (used + megabytes * 2**20,) * 2)
        try:
            pinik.solve_many(panda, "panda_hand_tcp", places, threads=500)
        except (MemoryError, RuntimeError):  # no memory, or no thread
            os._exit(1)
        os._exit(0)
    print(megabytes, os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]))
"""


@needs_native
@needs_a_limit_of_memory
def test_a_lack_of_memory_is_an_exception_and_does_not_end_the_process():
    code = [sys.executable, "-W", "ignore", "-c", LITTLE_MEMORY]
    done = subprocess.run(code, capture_output=True, text=True, check=True)
    ended = [line.split() for line in done.stdout.splitlines()]
    assert len(ended) == 32
    assert [line for line in ended if line[1] not in ("0", "1")] == [], done.stderr

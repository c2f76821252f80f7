# One environment, .venv, for everything. `make` alone lists the targets.

VENV := .venv
python := $(VENV)/bin/python
pip := $(python) -m pip --quiet --quiet --no-input --disable-pip-version-check
engine := CMakeLists.txt $(wildcard src/native/*.cmake src/native/*/*)
compiled := build/{wheel_tag}
sanitized := build/sanitized

ROOMS := solvers problem

# A sourced ROS workspace would put another Pinocchio, built for another Python, before ours.
unexport PYTHONPATH

.PHONY: help run test lint coverage mutants versions wheels sanitize bench notebooks docs clean

help:
	@echo "make run       install what is missing into $(VENV), run a tour and open the live view"
	@echo "make test      run every check: style, types and tests"
	@echo "make lint      check style and types only"
	@echo "make coverage  run the tests and tell which branches of src/pinik they miss"
	@echo "make mutants   tell which changes of ROOMS=\"solvers problem\" no test notices"
	@echo "make versions  build, install and try pinik under every other Python that it supports and that is found here"
	@echo "make wheels    build the sdist and the wheels into dist/, and try them in a fresh environment"
	@echo "make sanitize  run the engine's tests under AddressSanitizer and UndefinedBehaviorSanitizer"
	@echo "make bench     measure how fast the solvers are"
	@echo "make notebooks run the notebooks and save them with their pictures"
	@echo "make docs      build the documentation as a site in build/site"
	@echo "make clean     remove $(VENV) and everything else that was built here"
	@echo
	@echo "make PYTHON=/path/to/python3 … uses that Python for $(VENV)."

run: $(VENV)/installed
	@$(python) examples/tour.py
	@$(python) -m pinik live || test $$? -eq 130  # Ctrl-C is how it ends

test: lint
	@$(python) -m pytest --numprocesses=auto --dist=worksteal

lint: $(VENV)/installed-dev
	@$(python) -m ruff check .
	@$(python) -m ruff format --check .
	@$(python) -m mypy

# Processes that tests start are measured too, wherever they run, so the file has an absolute path.
coverage: export COVERAGE_FILE = $(CURDIR)/build/coverage/data
coverage: $(VENV)/installed-dev
	@rm -rf build/coverage && mkdir -p build/coverage
	@$(python) -m coverage run -m pytest --numprocesses=auto --dist=worksteal --timeout=600
	@$(python) -m coverage combine --quiet
	@$(python) -m coverage report --skip-covered --show-missing --sort=cover
	@$(python) -m coverage json --quiet -o build/coverage/report.json
	@$(python) tools/branch_coverage.py build/coverage/report.json 95

mutants: $(VENV)/installed-dev
	@$(pip) install 'mutmut>=3.8,<4'
	@$(python) tools/mutants.py $(ROOMS)

versions: $(python)
	@$(python) tools/try_versions.py

wheels: $(VENV)/installed-dev
	@$(python) tools/make_wheels.py

# Python itself is built without sanitizers, so their library must be loaded first and Python's own leaks be ignored.
# pytest must not capture the reports, which are written just before the process ends.
sanitize: $(VENV)/installed-dev $(sanitized)/built
	@LD_PRELOAD="$$($(CXX) -print-file-name=libasan.so) $$($(CXX) -print-file-name=libstdc++.so)" \
		ASAN_OPTIONS=detect_leaks=0 UBSAN_OPTIONS=print_stacktrace=1 \
		PINIK_REQUIRE_NATIVE=1 PINIK_SANITIZED_ENGINE="$$(echo $(sanitized)/pinik/_native*.so)" \
		PYTHONPATH=tests $(python) -m pytest -p sanitized_engine --capture=sys --timeout=3600 \
		tests/solving/test_native.py tests/solving/test_native_equivalence.py tests/solving/test_recalling.py \
		tests/solving/test_track.py tests/solving/test_tracker.py tests/solving/test_frame_arrays.py

bench: $(VENV)/installed-dev
	@$(python) -m pytest benchmarks --benchmark-enable --benchmark-only

notebooks: $(VENV)/installed-dev
	@$(python) tools/run_notebooks.py

docs: export NO_MKDOCS_2_WARNING = 1
docs: $(VENV)/installed-dev
	@$(python) tools/write_reference.py
	@$(python) -m mkdocs build --quiet
	@echo "The site is in build/site; open build/site/index.html in a browser"

clean:
	@rm -rf $(VENV) build dist .mypy_cache .pytest_cache .ruff_cache .hypothesis .benchmarks
	@find . -name __pycache__ -type d -prune -exec rm -rf {} +

$(python):
	@found=$$(PYTHON='$(PYTHON)' tools/find-python) && \
		echo "Making $(VENV) with $$found ($$("$$found" --version))" && \
		"$$found" -m venv --clear $(VENV) || { rm -rf $(VENV); exit 1; }

$(VENV)/installed: pyproject.toml $(engine) $(python)
	@echo "Installing pinik into $(VENV) (two or three minutes, as its engine is compiled)"
	@$(pip) install --editable '.[all]'
	@touch $@

$(VENV)/installed-dev: pyproject.toml $(engine) $(python)
	@echo "Installing pinik and its tools into $(VENV) (two or three minutes, as its engine is compiled)"
	@$(pip) install $$($(python) tools/build_requirements.py)
	@$(pip) install $$($(python) tools/build_requirements.py --with-tools)
	@$(pip) install --no-build-isolation --config-settings 'build-dir=$(compiled)' --editable '.[dev]'
	@touch $(VENV)/installed $@

$(sanitized)/built: pyproject.toml $(engine) $(python)
	@echo "Compiling the engine with sanitizers (several minutes)"
	@rm -rf $(sanitized)
	@$(pip) wheel --no-deps --wheel-dir $(sanitized) --config-settings build-dir=$(sanitized)/cmake \
		--config-settings cmake.define.PINIK_SANITIZE=ON .
	@$(python) -m zipfile -e $(sanitized)/*.whl $(sanitized)
	@touch $@

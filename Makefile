# From a fresh clone: `make demo` and `make test` need Python 3.11 or 3.13, Rust and make; they fetch and
# build the rest, into .venv, .venv-bpy-* and build/. `make help` lists what there is.

SHELL := bash
.SHELLFLAGS := -euo pipefail -c
.DELETE_ON_ERROR:
MAKEFLAGS += --no-builtin-rules
.DEFAULT_GOAL := help

PYTHON ?= python3
# A Blender with a window on a virtual screen; where there is none, the windowed tests are skipped.
BLENDER_GUI ?= ../shared/blender-gui/blender-gui

# One thread for BLAS: figures and tests do not depend on the machine's cores.
export OPENBLAS_NUM_THREADS := 1
export OMP_NUM_THREADS := 1
export MKL_NUM_THREADS := 1
export PIP_DISABLE_PIP_VERSION_CHECK := 1

VENV := .venv
BIN := $(VENV)/bin
# pyo3 asks this interpreter; the same for all cargo calls, or each would build everything anew.
export PYO3_PYTHON := $(CURDIR)/$(BIN)/python

# The Blenders, and of those with this Python the last: the one that `make test` takes as a module.
include release/blenders.mk
PYTHON_VERSION := $(shell $(PYTHON) -c 'import sys; print("%d.%d" % sys.version_info[:2])')
BPY ?= $(lastword $(foreach blender,$(BLENDERS),$(if $(filter $(PYTHON_VERSION),$(PYTHON_OF_$(blender))),$(blender))))
BPY_VENV := .venv-bpy-$(BPY)

# Without make's flags: its own jobs are not make's.
CARGO := env -u MAKEFLAGS -u MFLAGS cargo
CRATE := --locked --manifest-path native/Cargo.toml
NATIVE_SOURCES := $(wildcard native/*.toml native/*.lock native/*.pyi native/build.rs native/openmp/*.c) \
  $(shell find native/src -name '*.rs' 2>/dev/null)
EXTENSION_SOURCES := __init__.py LICENSE blender_manifest.toml \
  $(shell find addon operators core simulated cli -type f -not -path '*/__pycache__/*' 2>/dev/null) \
  $(shell find release -name '*.py' -o -name '*.txt' -o -name '*.mk')

.PHONY: help
help: ## this list
	@sed -nE 's/^([a-z-]+):.*## (.*)/  make \1\t\2/p' $(MAKEFILE_LIST) | expand -t 22

# ---------------------------------------------------------------------------------------- setup

.PHONY: setup
setup: $(VENV)/.servo-installed build/typing/palpate $(BPY_VENV)/.installed ## environments with everything in them

# Each environment and each product has a stamp beside it that is newer than all it was made from.
$(VENV)/.installed: pyproject.toml
	test -x $(BIN)/python || $(PYTHON) -m venv $(VENV)
	$(BIN)/pip install --quiet --editable '.[dev]'
	touch $@

# Of the servo there are two: the one of the package, and one that tests and benchmarks can step.
build/servo-harness/.built: $(NATIVE_SOURCES) $(VENV)/.installed
	rm -rf $(@D)
	mkdir -p $(@D)
	$(BIN)/maturin build --release --quiet $(CRATE) --features python,harness --out $(@D)
	touch $@

# On Linux for the oldest glibc that Blender runs on; elsewhere as the system compiles it.
build/servo/.built: $(NATIVE_SOURCES) $(wildcard release/compile_servo.py release/servo_wheel/*.py) $(VENV)/.installed
	rm -rf $(@D)
	mkdir -p $(@D)
	case $$(uname -sm) in \
	  'Linux x86_64') $(BIN)/python release/compile_servo.py linux-x64 --output $(@D) ;; \
	  'Linux aarch64') $(BIN)/python release/compile_servo.py linux-arm64 --output $(@D) ;; \
	  *) $(BIN)/maturin build --release --quiet $(CRATE) --features python --out $(@D) ;; \
	esac
	touch $@

$(VENV)/.servo-installed: build/servo-harness/.built
	$(BIN)/pip install --quiet --force-reinstall --no-deps build/servo-harness/*.whl
	touch $@

# The name under which type checkers find the package (see pyproject.toml).
build/typing/palpate:
	mkdir -p build/typing
	ln -sfn ../.. $@

# Blender as a module, alone with pytest: what the extension imports must come from its own wheels.
.venv-bpy-/.installed:
	@echo 'Blender as a module exists for Python 3.11 and 3.13, and $(PYTHON) is $(PYTHON_VERSION).' \
	  'Name one of these (make PYTHON=python3.13 ...) or a Blender (make BPY=5.2.3 ...).' >&2; exit 1

.PRECIOUS: .venv-bpy-%/.installed
.venv-bpy-%/.installed:
	python=$$(release/find_python.sh $(PYTHON_OF_$*) $(PYTHON)); "$$python" -m venv .venv-bpy-$*
	.venv-bpy-$*/bin/pip install --quiet bpy==$* pytest pytest-timeout pytest-xdist hypothesis
	touch $@

# ------------------------------------------------------------------------------------- packages

.PHONY: package
package: build/packages/.made ## the extension for Blender on this system, checked by Blender's own tool
	@ls -l build/packages/palpate-[0-9]*.zip

build/packages/.made: build/servo/.built $(EXTENSION_SOURCES) | $(BPY_VENV)/.installed
	rm -f build/packages/palpate-[0-9]*.zip
	$(BIN)/python release/build_extension.py --servo-wheel build/servo/*.whl --blender $(BPY_VENV)
	touch $@

# Systems by name, or all.
SYSTEMS ?=
.PHONY: package-all
package-all: $(VENV)/.installed | $(BPY_VENV)/.installed ## the extension for every system, compiled from here; see build/packages-all
	$(BIN)/python release/package_all.py $(SYSTEMS) --blender $(BPY_VENV) --output build/packages-all

# The windowed Blender may be of another Python than the official ones, and gets a package of its own.
WINDOWED_PACKAGE := $(if $(wildcard $(BLENDER_GUI)),build/packages/palpate-windowed.zip)

build/packages/palpate-windowed.zip: build/servo/.built $(EXTENSION_SOURCES) | $(BPY_VENV)/.installed
	$(BLENDER_GUI) setup
	version=$$($(BLENDER_GUI) sh python3 -c 'import sys; print("%d.%d" % sys.version_info[:2])'); \
	  $(BIN)/python release/build_extension.py --servo-wheel build/servo/*.whl --blender $(BPY_VENV) \
	  --python "$$version" --name $(notdir $@)

# ---------------------------------------------------------------------------------------- tests
# Each part leaves its output in build/reports, so that its closing lines can be read together.

REPORT = 2>&1 | tee build/reports/$@.txt
APPENDED = 2>&1 | tee --append build/reports/$@.txt
ON_ALL_CORES := --numprocesses auto --maxprocesses 4 --dist loadfile

# What the engine answers does not depend on when it is asked.
ENGINE_TESTS := tests/servo/engine tests/servo/contact
CORE_TESTS := tests/core $(ENGINE_TESTS) tests/simulated tests/cli tests/passivity tests/demo tests/release \
  tests/test_architecture.py tests/test_docs.py tests/test_examples.py
# They have deadlines and mostly wait.
ON_TWO_CORES := --numprocesses auto --maxprocesses 2 --dist loadfile
SERVO_TESTS := tests/servo tests/firmware $(ENGINE_TESTS:%=--ignore=%)

# What compiles and downloads goes side by side; a make that knows how (4.0 and later) prints each part
# in one piece. The parts of the tests come one after the other: some have deadlines, others fill all cores.
SIDE_BY_SIDE := $(MAKE) --jobs=2 $(if $(filter output-sync,$(.FEATURES)),--output-sync)

.PHONY: test
test: ## everything that must hold, in a few minutes
	$(SIDE_BY_SIDE) $(VENV)/.installed $(BPY_VENV)/.installed
	$(SIDE_BY_SIDE) lint test-native build/packages/.made $(WINDOWED_PACKAGE)
	$(MAKE) test-core test-servo test-addon test-gui

.PHONY: test-all
test-all: test test-at-length test-drags $(BLENDERS:%=test-addon-%) check-systems ## the same, the extension in every Blender, the servo for every system

.PHONY: test-at-length
test-at-length: $(VENV)/.servo-installed $(BPY_VENV)/.installed build/packages/.made $(WINDOWED_PACKAGE) | build/reports ## of all parts what takes long
	$(BIN)/pytest -q -m at_length $(ON_ALL_CORES) $(CORE_TESTS) $(REPORT)
	$(BIN)/pytest -q -m at_length $(ON_TWO_CORES) $(SERVO_TESTS) $(APPENDED)
	$(BPY_VENV)/bin/pytest -q -m at_length $(ON_ALL_CORES) tests/addon $(APPENDED)
	BLENDER_GUI='$(BLENDER_GUI)' $(BIN)/pytest -q -m at_length tests/gui $(APPENDED)

build/reports:
	mkdir -p $@

.PHONY: lint
lint: $(VENV)/.servo-installed build/typing/palpate | build/reports ## linters, formatters and types
	$(CARGO) fmt --check --manifest-path native/Cargo.toml
	$(CARGO) clippy --quiet $(CRATE) --all-targets --all-features -- -D warnings
	$(BIN)/ruff check --quiet --output-format concise .
	$(BIN)/ruff format --check --quiet .
	$(BIN)/mypy $(REPORT)
	$(BIN)/mypy release/*.py release/servo_wheel/*.py

.PHONY: test-native
test-native: $(VENV)/.installed | build/reports ## the servo's own tests
	$(CARGO) test --quiet $(CRATE) --features harness $(REPORT)

.PHONY: test-core
test-core: $(VENV)/.servo-installed | build/reports ## core, engine, command line and packages, without Blender
	$(BIN)/pytest -q $(ON_ALL_CORES) $(CORE_TESTS) $(REPORT)

.PHONY: test-servo
test-servo: $(VENV)/.servo-installed | build/reports ## servo and firmware, two at once at most
	$(BIN)/pytest -q $(ON_TWO_CORES) $(SERVO_TESTS) $(REPORT)

.PHONY: test-addon
test-addon: test-addon-$(BPY) ## the package installed in Blender as a module, driven by its operators

.PHONY: $(BLENDERS:%=test-addon-%)
$(BLENDERS:%=test-addon-%): test-addon-%: .venv-bpy-%/.installed build/packages/.made | build/reports
	.venv-bpy-$*/bin/pytest -q $(ON_ALL_CORES) tests/addon $(REPORT)

# Under wine, in a root folder outside of the checkout, which is made if it is not there: 3 GB, as root.
WINDOWS_ROOT ?= /var/tmp/palpate-windows
WINDOWS_TESTS ?= tests/core tests/cli tests/simulated tests/servo
# Those that wait for nothing in real time, in two minutes.
WINDOWS_SHORT_TESTS := tests/simulated tests/core/files/windows tests/core/body/test_mapped_body.py \
  tests/core/contact/test_same_on_every_system.py
WINDOWS_ADDON_TESTS ?= tests/addon
WINDOWS_WHEELS := build/servo-of-windows
WINDOWS_PACKAGES := build/packages-windows

$(WINDOWS_WHEELS)/.built: $(NATIVE_SOURCES) $(VENV)/.installed
	$(BIN)/python release/compile_servo.py windows-x64 --features python,harness --output $(@D)
	touch $@

$(WINDOWS_PACKAGES)/.made: $(NATIVE_SOURCES) $(EXTENSION_SOURCES) $(VENV)/.installed | $(BPY_VENV)/.installed
	$(BIN)/python release/package_all.py windows-x64 --blender $(BPY_VENV) --output $(@D)
	touch $@

.PHONY: windows-root
windows-root:
	release/windows/make_root.sh $(WINDOWS_ROOT)

.PHONY: test-windows
test-windows: test-windows-native test-windows-python test-windows-addon ## all of it for Windows, under wine; see docs/releasing.md

.PHONY: test-windows-native
test-windows-native: windows-root | build/reports ## the servo's own tests, under wine
	release/windows/test_native.sh $(WINDOWS_ROOT) $(REPORT)

.PHONY: test-windows-python
test-windows-python: windows-root $(WINDOWS_WHEELS)/.built | build/reports ## servo, core, simulated devices and command line in the Python of Windows, under wine
	PYTHON=$(BIN)/python release/windows/test.sh $(WINDOWS_ROOT) $(WINDOWS_WHEELS)/*.whl 313 $(WINDOWS_TESTS) $(REPORT)

.PHONY: test-windows-shortly
test-windows-shortly: windows-root $(WINDOWS_WHEELS)/.built | build/reports ## of these, what does not depend on time
	PYTHON=$(BIN)/python release/windows/test.sh $(WINDOWS_ROOT) $(WINDOWS_WHEELS)/*.whl 313 $(WINDOWS_SHORT_TESTS) $(REPORT)

.PHONY: test-windows-addon
test-windows-addon: test-windows-addon-$(lastword $(BLENDERS)) ## the package in Blender as a module for Windows, under wine

.PHONY: $(BLENDERS:%=test-windows-addon-%)
$(BLENDERS:%=test-windows-addon-%): test-windows-addon-%: windows-root $(WINDOWS_PACKAGES)/.made | build/reports
	PYTHON=$(BIN)/python release/windows/test_addon.sh $(WINDOWS_ROOT) \
	  $(WINDOWS_PACKAGES)/palpate-[0-9]*-windows_x64.zip $(subst .,,$(PYTHON_OF_$*)) $* $(WINDOWS_ADDON_TESTS) $(REPORT)

.PHONY: demo-windows
demo-windows: demo-windows-$(lastword $(BLENDERS)) ## the demo in Blender for Windows, under wine; see build/demo-windows

.PHONY: $(BLENDERS:%=demo-windows-%)
$(BLENDERS:%=demo-windows-%): demo-windows-%: $(VENV)/.servo-installed windows-root $(WINDOWS_PACKAGES)/.made
	PYTHON=$(BIN)/python $(BIN)/python demo/make_demo.py \
	  --blender release/windows/blender_python.sh $(WINDOWS_ROOT) $(subst .,,$(PYTHON_OF_$*)) $* \
	  --package $(WINDOWS_PACKAGES)/palpate-[0-9]*-windows_x64.zip --output build/demo-windows

# Compiles without linking, for those systems whose standard library rustup has put here.
.PHONY: check-systems
check-systems: $(VENV)/.installed
	for target in x86_64-pc-windows-msvc aarch64-apple-darwin; do \
	  if [ -d "$$(rustc --print sysroot)/lib/rustlib/$$target" ]; then \
	    $(CARGO) check --quiet $(CRATE) --all-targets --all-features --target "$$target"; \
	    echo "compiles for $$target"; \
	  else echo "not compiled for $$target: rustup target add $$target"; fi; \
	done

.PHONY: test-gui
test-gui: $(VENV)/.servo-installed $(WINDOWED_PACKAGE) | build/reports ## the package in a Blender with a window, where there is one
	BLENDER_GUI='$(BLENDER_GUI)' $(BIN)/pytest -q tests/gui $(REPORT)

.PHONY: test-drags
test-drags: $(VENV)/.servo-installed $(WINDOWED_PACKAGE) ## twenty drags at random places of each sample body, at two sizes of the interface
	BLENDER_GUI='$(BLENDER_GUI)' $(BIN)/python tests/gui/drags/play.py

.PHONY: release-check
release-check: $(VENV)/.installed ## all that a release must hold, of every system, as a table
	$(BIN)/python release/release_check.py

# ---------------------------------------------------------------------------- demo, benchmarks

.PHONY: demo
demo: $(VENV)/.servo-installed build/packages/.made ## the main job on a plush mouse and a cube; see build/demo
	$(BIN)/python demo/make_demo.py --blender $(BPY_VENV)/bin/python \
	  --package build/packages/palpate-[0-9]*.zip --output build/demo

# What is seen in the window is played there, so the pictures are what a user sees. Pictures of measurements are made by
# their benchmarks: cost_against_size.py --docs (cost.png), passivity_map.py --docs (passivity.png), and with --picture
# locking.py (locking.png) and pressed_materials.py (pressed-materials.png).
PICTURED := newcomer or comes_back or shows_its_patch_and_force or two_handles_pinch
.PHONY: pictures
pictures: $(VENV)/.servo-installed $(BPY_VENV)/.installed build/packages/.made $(WINDOWED_PACKAGE) ## the pictures of all documents anew, but those of measurements
	BLENDER_GUI='$(BLENDER_GUI)' $(BIN)/pytest -q tests/gui -k '$(PICTURED)'
	$(BIN)/python demo/window_pictures.py
	$(BPY_VENV)/bin/python demo/picture_scene.py sample_scenes/drumstick.blend docs/images/drumstick.png
	$(BIN)/python demo/make_demo.py --blender $(BPY_VENV)/bin/python \
	  --package build/packages/palpate-[0-9]*.zip --output build/demo --readme docs/images/press.png
	$(BPY_VENV)/bin/python demo/picture_shapes.py \
	  --package build/packages/palpate-[0-9]*.zip --output docs/images/shapes.png
	$(BIN)/python benchmarks/shape/paper_tables.py --picture docs/images/figure-4.png

.PHONY: translations
translations: $(VENV)/.installed ## new texts into addon/translations/*.po, and old ones out
	$(BIN)/python release/translations.py

.PHONY: bench
bench: $(VENV)/.servo-installed build/packages/.made | build/reports ## how long things take on this machine, beside others; see build/reports/bench.txt
	$(BIN)/pip install --quiet --editable '.[dev,bench]'
	$(BIN)/palpate devices attack simulated --times 1000 $(REPORT)
	$(BIN)/python benchmarks/files/fuzz.py --blender $(BPY_VENV)/bin/python $(APPENDED)
	$(BIN)/python benchmarks/servo/servo_timing.py --link $(APPENDED)
	for script in $(filter-out benchmarks/measuring/% benchmarks/files/fuzz.py,$(wildcard benchmarks/*/*.py)); do $(BIN)/python "$$script"; done $(APPENDED)

.PHONY: attack
attack: $(VENV)/.servo-installed build/board ## the tables of docs/safety.md: a hostile device at the servo, and processes that end
	$(BIN)/palpate devices attack simulated --times 200 --publish docs/safety.md
	$(BIN)/palpate devices attack simulated --real --board build/board --times 50 --kept build/attacked.json --publish docs/safety.md
	rm build/attacked.json

build/board: firmware/host/main.cpp $(wildcard firmware/palpate_link/src/*)
	mkdir -p $(@D)
	$(CXX) -std=c++17 -O1 -I firmware/palpate_link/src $< -o $@

# ------------------------------------------------------------------------------------------ rest

.PHONY: clean
clean: ## delete everything made, except the environments
	rm -rf build native/target *.egg-info .mypy_cache .ruff_cache .pytest_cache .hypothesis

# Everything a fresh machine needs: Python >= 3.11 and make.
PYTHON ?= python3
VENV   := .venv
PY     := $(VENV)/bin/python
RUN_STAMP := $(VENV)/.run-ready
DEV_STAMP := $(VENV)/.dev-ready
# Each of many processes would compile the same modules anew.
unexport PYTHONDONTWRITEBYTECODE

BENCHES := bench-wave bench-accuracy bench-peers bench-scale bench-liver bench-vision bench-tracking bench-gate bench-sweep bench-discovery bench-effects bench-derivatives bench-haptic bench-press bench-fit
.PHONY: help run test test-slow test-torture $(BENCHES) lint types imports check docs pictures lock clean

help:
	@echo "make run              phantom trials, the 5 N skin press, and a hidden effect found: three reports"
	@echo "make test             the tests (under 10 minutes on 2 cores)"
	@echo "make test-slow        the long checks"
	@echo "make test-torture     kills, malformed files, full disks, bad surroundings, a table of each (25 minutes at most)"
	@echo "make check            lint, types and import rules"
	@echo "make docs             the documentation as a site in build/site"
	@echo "make pictures         the pictures of the documentation anew, from examples/ (minutes)"
	@echo "make bench-wave       microseconds a frame of the wave beside its rivals, each with its error"
	@echo "make bench-accuracy   the wave's errors against the finite elements, small and finite strain"
	@echo "make bench-peers      the same problems through FElupe and CalculiX, where they are installed"
	@echo "make bench-scale      time and memory of a press in three dimensions from 20 thousand unknowns to a million"
	@echo "make bench-liver      a synthetic liver from its STL file to a pressed VTU"
	@echo "make bench-vision     frames a second of the tracker, and its memory on a long video"
	@echo "make bench-tracking   what the tracker keeps of stretch, ellipses, blur, glare and shadow, beside the article's method"
	@echo "make bench-effects    wave and finite elements with each body effect, side by side"
	@echo "make bench-derivatives  what derivatives of a press cost, and CalculiX as their judge"
	@echo "make bench-haptic       latency of a million steps of the haptic loop"
	@echo "make bench-press        frames a second of the page to press, in Chromium without a graphics card"
	@echo "make bench-fit        what a fit of five parameters costs beside lmfit and an optimisation as FEBio does it"
	@echo "make bench-sweep      a sweep by one and by two local workers"
	@echo "make bench-gate       the regression gate on trial: false alarms and power (hours at full length)"
	@echo "make bench-discovery  the discovery on 150 sessions with hidden effects (hours)"
	@echo "make lock             pin the dependencies anew"

$(PY):
	$(PYTHON) -c 'import sys; sys.exit("tissuebench needs Python 3.11 or newer, this is " + sys.version.split()[0]) if sys.version_info < (3, 11) else None'
	$(PYTHON) -m venv $(VENV)

$(RUN_STAMP): requirements.lock pyproject.toml | $(PY)
	$(PY) -m pip install --quiet --disable-pip-version-check --requirement requirements.lock
	$(PY) -m pip install --quiet --disable-pip-version-check --no-deps --editable .
	@touch $@

$(DEV_STAMP): requirements-dev.lock $(RUN_STAMP)
	$(PY) -m pip install --quiet --disable-pip-version-check --requirement requirements-dev.lock
	@touch $@

run: $(RUN_STAMP)
	$(PY) -m benchmark run

# Two processes share the cores: one thread a library in each. What is shared by tests is made by one of them, mostly.
test: export OPENBLAS_NUM_THREADS = 1
test: export OMP_NUM_THREADS = 1
test: export MKL_NUM_THREADS = 1
test: $(DEV_STAMP)
	$(PY) -m pytest -n 2 --dist worksteal

test-slow: $(DEV_STAMP)
	$(PY) -m pytest -n 2 -m slow

test-torture: $(DEV_STAMP)
	$(PY) -m tests.torture

lint: $(DEV_STAMP)
	$(VENV)/bin/ruff check .
	$(VENV)/bin/ruff format --check .

types: $(DEV_STAMP)
	$(VENV)/bin/mypy

imports: $(DEV_STAMP)
	$(VENV)/bin/lint-imports

check: lint types imports

docs: $(DEV_STAMP)
	$(PY) -m benchmark.files.reference > docs/reference-files.md
	$(PY) -m mkdocs build --quiet

pictures: $(RUN_STAMP)
	mkdir -p build/pictures
	MPLBACKEND=Agg $(PY) examples/theory_figures.py docs/pictures
	MPLBACKEND=Agg $(PY) examples/video_figures.py docs/pictures
	set -e; for script in examples/gallery/*.py; do (cd build/pictures && MPLBACKEND=Agg ../../$(PY) ../../$$script); done
	cp build/pictures/*.png docs/pictures

bench-wave: $(RUN_STAMP)
	$(PY) -m tests.performance.wave

bench-accuracy: $(RUN_STAMP)
	$(PY) -m tests.performance.wave.linear
	$(PY) -m tests.performance.wave.tissues
	$(PY) -m tests.performance.wave.laws

bench-peers: $(DEV_STAMP)
	$(PY) -m tests.performance.peers

bench-scale: $(RUN_STAMP)
	$(PY) -m tests.performance.scale

bench-liver: $(RUN_STAMP)
	$(PY) -m tests.performance.liver results/liver

bench-vision: $(RUN_STAMP)
	$(PY) -m tests.performance.vision

bench-tracking: $(RUN_STAMP)
	$(PY) -m tests.performance.tracking

# GATE_RUNS=3 for a short one.
GATE_RUNS ?= 20
bench-gate: $(DEV_STAMP)
	$(PY) -m tests.performance.gate_trial --runs $(GATE_RUNS) --together --only wave.frame fem.assembly fit
	$(PY) -m tests.performance.gate_trial --runs $(GATE_RUNS) --off 0.01 --values

bench-effects: $(RUN_STAMP)
	$(PY) -m tests.performance.effects

bench-derivatives: $(RUN_STAMP)
	$(PY) -m tests.performance.derivatives

bench-haptic: $(RUN_STAMP)
	$(PY) -m tests.performance.haptic

bench-press: $(DEV_STAMP)
	$(PY) -m benchmark press skin-5N --save build/press.html
	$(PY) -m tests.performance.press_page build/press.html

bench-fit: $(RUN_STAMP)
	$(PY) -m tests.performance.identification

bench-sweep: $(RUN_STAMP)
	$(PY) -m tests.performance.sweep

# The table goes to tests/performance/discovery; the same command goes on where it was stopped.
bench-discovery: $(RUN_STAMP)
	$(PY) -m benchmark blind --suite first --out tests/performance/discovery

# Needs uv (`pip install uv`). Only names and versions are written, no addresses.
lock:
	uv pip compile --universal --python-version 3.11 --no-header --no-annotate \
		--extra all --output-file requirements.lock pyproject.toml
	uv pip compile --universal --python-version 3.11 --no-header --no-annotate \
		--extra all --extra dev --extra peers --output-file requirements-dev.lock pyproject.toml

clean:
	rm -rf $(VENV) build dist *.egg-info

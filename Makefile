# Everything a fresh machine needs: Python >= 3.11 and make.
PYTHON ?= python3
VENV   := .venv
PY     := $(VENV)/bin/python
RUN_STAMP := $(VENV)/.run-ready
DEV_STAMP := $(VENV)/.dev-ready

.PHONY: help run test test-slow bench-vision lint types imports check lock clean

help:
	@echo "make run        phantom trials from their films, and the 5 N skin press, to two reports"
	@echo "make test       the tests (under 10 minutes on 2 cores)"
	@echo "make test-slow  the long checks"
	@echo "make bench-vision  speed and memory of the marker tracker"
	@echo "make check      lint, types and import rules"
	@echo "make lock       pin the dependencies anew"

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

test: $(DEV_STAMP)
	$(PY) -m pytest -n 2

test-slow: $(DEV_STAMP)
	$(PY) -m pytest -n 2 -m slow

bench-vision: $(RUN_STAMP)
	$(PY) -m benchmarks.vision

lint: $(DEV_STAMP)
	$(VENV)/bin/ruff check .
	$(VENV)/bin/ruff format --check .

types: $(DEV_STAMP)
	$(VENV)/bin/mypy

imports: $(DEV_STAMP)
	$(VENV)/bin/lint-imports

check: lint types imports

# Needs uv (`pip install uv`). Only names and versions are written, no addresses.
lock:
	uv pip compile --universal --python-version 3.11 --no-header --no-annotate --no-emit-index-url \
		--output-file requirements.lock pyproject.toml
	uv pip compile --universal --python-version 3.11 --no-header --no-annotate --no-emit-index-url \
		--extra dev --extra peers --output-file requirements-dev.lock pyproject.toml

clean:
	rm -rf $(VENV) build dist *.egg-info

# The project's commands. `make test` sets up everything it needs.
export UV_PYTHON_DOWNLOADS := never
UV := $(or $(shell command -v uv),.tools/uv/bin/uv)
BIN := .venv/bin

.PHONY: test check
test: check
	$(BIN)/pytest

check: .venv/.installed
	$(BIN)/ruff format --check .
	$(BIN)/ruff check .
	$(BIN)/mypy

.tools/uv/bin/uv:
	python3 -m venv .tools/uv
	.tools/uv/bin/pip install --quiet uv

.venv/.installed: requirements-dev.lock pyproject.toml | $(UV)
	$(UV) venv --quiet --allow-existing .venv
	$(UV) pip install --quiet --require-hashes -r requirements-dev.lock
	$(UV) pip install --quiet --no-deps -e .
	touch $@

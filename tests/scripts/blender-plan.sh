#!/bin/bash
# How the script for Blender reads a plan: names that lead out of its folder are refused. Also its messages about scenes
# that it cannot render correctly.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
command -v python3 >/dev/null || { echo "skipped: needs python3"; exit 77; }
PYTHONDONTWRITEBYTECODE=1 python3 tests/scripts/blender-plan.py share/blender

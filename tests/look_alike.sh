#!/bin/sh
# Usage: tests/look_alike.sh [PAIRS] [BUILD]: drives past so many pairs of look-alike places (200) and fails if a false closure lasts.
set -eu
SLAMMOT_LOOK_ALIKE_PAIRS="${1:-200}" "${2:-build/release}/bin/unit_loop_closing" --gtest_filter='LookAlikePlaces.*'

#!/usr/bin/env bash
# Renders one scene here and in wasm and compares the films to the last bit.
set -euo pipefail
cd "$(dirname "$0")"
target=${CARGO_TARGET_DIR:-../../target}/wasm-check
rustup target list --installed | grep -q wasm32-unknown-unknown || rustup target add wasm32-unknown-unknown
cargo build --quiet --release --target-dir "$target"
cargo build --quiet --release --lib --target wasm32-unknown-unknown --target-dir "$target"
here=$("$target/release/native")
there=$(node run.mjs "$target/wasm32-unknown-unknown/release/etendue_wasm_check.wasm")
echo "native $here"
echo "wasm32 $there"
[ "$here" != 00000000000000000000000000000000 ] || { echo "the scene could not be built"; exit 1; }
[ "$here" = "$there" ] || { echo "the films differ"; exit 1; }

#!/usr/bin/env bash
# Blender's modules of the versions between those that the other tests run, each in an environment of its own in build/envs (some
# 1 GB each). Called by scripts/test --platforms.
source "$(dirname "${BASH_SOURCE[0]}")/../../scripts/common.sh"
for version in 4.2 4.3 4.4; do make_environment "bpy-$version" "$(find_python 3.11)"; done
for version in 5.1 5.3; do make_environment "bpy-$version" "$(find_python 3.13)"; done

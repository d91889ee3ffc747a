#!/usr/bin/env bash
# The last step of an image: builds the workspace, which whoever runs the image may build again.
set -euo pipefail
scripts/setup.sh "$@"
rm -rf "$HOME/.cache" "$HOME/.ros"
mkdir -p out
chmod -R a+rwX .setup build devel out src/sim/bullet_sim/src/bullet_sim/data/models src/compat/turtlebot3_gazebo/{models,worlds} src/{compat,navigation}/names
docker/lists.sh . >/usr/local/share/workspace-lists

# What each terminal in a container starts with: the workspace of this folder, else the image's own.
for folder in "$PWD" /home/learner/ws; do
  [ ! -f "$folder/devel/setup.bash" ] || { . "$folder/devel/setup.bash"; break; }
done
unset folder

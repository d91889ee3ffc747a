# Sourced by devel/setup.bash: roscd and rosls, which Debian leaves in a folder that no setup file reads.
if [ -r /usr/share/bash-completion/completions/roscd ]; then
  . /usr/share/bash-completion/completions/roscd
fi

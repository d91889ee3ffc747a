# Step 2: Debian packages.
wanted_packages() { sed 's/#.*//' "$lists/debian.txt" $([ "$tests" = no ] || echo "$lists/debian-test.txt") | awk 'NF {print $1}' | sort -u; }
missing_packages() {
  wanted_packages | xargs dpkg-query -W -f '${Package} ${db:Status-Status}\n' 2>/dev/null |
    awk '$2 == "installed" {print $1}' | sort -u | comm -13 - <(wanted_packages) || true
}
as_root() {
  local keep=(DEBIAN_FRONTEND=noninteractive LC_ALL=C PATH="$PATH") name
  for name in http_proxy https_proxy no_proxy; do [ -z "${!name:-}" ] || keep+=("$name=${!name}"); done
  if [ "$(id -u)" = 0 ]; then env "${keep[@]}" "$@"; else sudo env "${keep[@]}" "$@"; fi
}
apt() { as_root apt-get -q -y -o DPkg::Lock::Timeout=600 -o Acquire::Retries=2 -o Dpkg::Use-Pty=0 "${sources[@]}" "$@"; }
install_packages() { apt install --no-install-recommends "${missing[@]}"; }
mend_and_install() { as_root dpkg --configure -a && apt install -f --no-remove && install_packages; }
debian_packages() {
  [ ${#missing[@]} -gt 0 ] || return 0
  step 2 $"installing ${#missing[@]} Debian packages and what they depend on (some minutes, 360 MB on a bare machine)"
  logged apt-update apt update || fail_with_log $"apt-get update failed" apt-update
  logged apt-install install_packages || diagnose_apt
}
# Packages left unconfigured by a killed setup can be repaired here; anything else is up to the user.
diagnose_apt() {
  ! network_failed apt-install || fail $"no network: apt cannot fetch the packages (.setup/apt-install.log says more); connect and run this again"
  if grep -q 'Unable to locate package' "$state/apt-install.log"; then
    ! network_failed apt-update || fail $"no network: apt cannot reach the package archive (.setup/apt-update.log says more); connect and run this again"
    fail $"apt does not know all packages: /etc/apt/sources.list needs a line like \"deb http://deb.debian.org/debian ${platform%-*} main\""
  fi
  logged apt-mend mend_and_install || fail_with_log $"apt-get install failed" apt-mend
}

#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# install.sh -- installs what `packages` (beside this file) lists and this machine lacks.
#
#   third_party/install.sh          what the build needs
#   third_party/install.sh --tests  what the tests need as well
#
# Quiet and quick when nothing is missing. Debian 12 or newer, or a system derived from it.
set -eu
list=$(dirname "$0")/packages

die()
{
    echo "install.sh: $*" >&2
    exit 1
}

case ${1-} in
'') sections=build ;;
--tests) sections='build tests' ;;
*) die "unknown option '$1'; the only one is --tests" ;;
esac

# The first words of the lines in the wanted sections: "name" or "name|other|...".
wanted()
{
    section=
    while read -r word _; do
        case $word in
        '' | '#'*) ;;
        '['*']') section=${word#[} section=${section%]} ;;
        *) case " $sections " in *" $section "*) echo "$word" ;; esac ;;
        esac
    done <"$list"
}

# Entries of which no alternative is installed.
missing()
{
    # dpkg-query fails when it does not know one of the names; what it knows it prints.
    # shellcheck disable=SC2046
    have=$(dpkg-query -W -f '${Package} ${db:Status-Status}\n' $(wanted | tr '|' ' ') \
        2>/dev/null || true)
    for entry in $(wanted); do
        found=no
        for name in $(echo "$entry" | tr '|' ' '); do
            case "
$have
" in *"
$name installed
"*) found=yes ;; esac
        done
        [ $found = yes ] || echo "$entry"
    done
}

# The alternative of "name|other|..." that this release offers; nothing if it offers none.
offered()
{
    for name in $(echo "$1" | tr '|' ' '); do
        case $(apt-cache policy "$name") in
        '' | *'Candidate: (none)'*) ;;
        *) echo "$name" && return ;;
        esac
    done
}

as_root()
{
    if [ "$(id -u)" = 0 ]; then "$@"; else sudo "$@"; fi
}

apt_get()
{
    as_root env DEBIAN_FRONTEND=noninteractive apt-get -qq -o=Dpkg::Use-Pty=0 "$@"
}

command -v dpkg-query >/dev/null ||
    die "this system has no dpkg; install by hand what $list lists"
entries=$(missing)
[ -n "$entries" ] || exit 0
command -v apt-get >/dev/null ||
    die "apt-get is absent; install by hand: $(echo "$entries" | tr '\n' ' ')"
[ "$(id -u)" = 0 ] || command -v sudo >/dev/null ||
    die "needs root or sudo to install $(echo "$entries" | tr '\n' ' ')"

names=
updated=no
for entry in $entries; do
    name=$(offered "$entry")
    if [ -z "$name" ] && [ $updated = no ]; then
        apt_get update
        updated=yes
        name=$(offered "$entry")
    fi
    [ -n "$name" ] || die "this release has no package $entry"
    names="$names $name"
done

echo "installing$names" >&2
# Old lists name files that the archive no longer holds: refresh them once and try again.
# shellcheck disable=SC2086
apt_get install -y --no-install-recommends $names >/dev/null || {
    [ $updated = no ] || die "apt-get could not install$names"
    apt_get update
    apt_get install -y --no-install-recommends $names >/dev/null ||
        die "apt-get could not install$names"
}

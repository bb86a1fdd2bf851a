#!/bin/bash
# spy_test.sh SOURCE TYPES_JAR LAUNCHER: lcm-spy decodes every message of a running stream ("Undecodable 0"), and our
# launcher starts it. In a network and a display of its own, so that it disturbs nobody and nobody disturbs it.
# Ends with 77, and says why, where that is not possible. SPY_PICTURE=file.png keeps a picture of lcm-spy's window.
set -u
source=$1 types=$2 launcher=$3
here=$(cd "$(dirname "$0")" && pwd)

skip() { echo "skipped: $*"; exit 77; }

if [[ -z ${KOPPEL_SPY_TEST_INSIDE-} ]]; then
  for program in java javac Xvfb xvfb-run unshare ip; do
    command -v "$program" > /dev/null || skip "$program is not installed"
  done
  [[ -e $types ]] || skip "$types was not built"
  for jar in lcm jchart2d; do
    [[ -e /usr/share/java/$jar.jar ]] || skip "/usr/share/java/$jar.jar is not installed (liblcm-java)"
  done
  # Root may make a network namespace; others inside a user namespace, where the system allows that.
  new_network=(unshare --net)
  [[ $(id -u) == 0 ]] || new_network=(unshare --map-root-user --net)
  "${new_network[@]}" true 2> /dev/null || skip "this user may not make a network namespace"
  KOPPEL_SPY_TEST_INSIDE=yes exec "${new_network[@]}" xvfb-run -a "$0" "$@"
fi

ip link set lo up multicast on && ip route add 224.0.0.0/4 dev lo || skip "no multicast in the new network namespace"
scratch=$(mktemp -d)
trap 'kill $(jobs -p) 2> /dev/null; rm -rf "$scratch"' EXIT
url="udpm://239.255.76.67:7667?ttl=0"
classes=/usr/share/java/lcm.jar:/usr/share/java/jchart2d.jar:$types

"$source" "$url" 100000 20 > /dev/null &
javac -nowarn -cp "$classes" -d "$scratch" "$here/SpyProbe.java" || exit 1
if [[ -n ${SPY_PICTURE-} ]]; then
  (for _ in {1..60}; do sleep 0.5; import -silent -window root "$SPY_PICTURE"; done) &
fi
expected=()
for kind in model state poses closure event; do
  expected+=("KOPPEL_FOUR_BAR_${kind^^}=koppel.${kind}_t")
done
java -Djava.net.preferIPv4Stack=true -cp "$classes:$scratch" lcm.spy.SpyProbe "$url" "${expected[@]}" || exit 1

# The launcher: it must find our types and stay.
KOPPEL_TYPES_JAR=$types timeout 10 "$launcher" --lcm-url "$url" > "$scratch/launcher" 2>&1
status=$?
cat "$scratch/launcher"
[[ $status == 124 ]] || { echo "the launcher ended by itself with $status"; exit 1; }
grep -q "Found 6 LCM types" "$scratch/launcher" || { echo "the launcher's lcm-spy did not find our types"; exit 1; }

#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
#
# POV-Ray is a ray tracer; pinned here: Debian 12 povray 1:3.7.0.10-2+b2 (POV-Ray 3.7.0.10).
#
# Expected: a smooth triangle is shaded with the normals given at its corners. The reference manual, 3.4.5.2.7 (Smooth
# Triangle), says that the normal at a point is interpolated from the three, and 3.4.5.2.4.1 (Smooth and Flat triangles
# in the same mesh) that the triangles without normal indices are flat. Neither asks that the three normals differ.
#
# Found: inside mesh and mesh2, a triangle whose three normals are equal, or differ by less than about 1e-5, is shaded
# with the normal of its plane, and the given normals are dropped without a warning. The same triangle written as a lone
# smooth_triangle keeps them, and so does the mesh if the normals differ by 1e-3.
#
# Why it matters to a user of a render server: cards for leaves and grass, and other flat stand-ins for round things,
# are often given one shared normal so that they are lit like what they stand for. A mesh of such cards gets another
# brightness in POV-Ray than the manual gives, so a comparison of pictures blames the wrong renderer.
set -euo pipefail

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
stop() { echo "CHANGED OR UNTESTED: $*" >&2; exit 1; }

# Takes the pinned packages, and those of their dependencies that this system lacks, without installing any.
fetch_debian() {
  local missing deb
  missing=$(missing_for "$@") || { apt-get update -qq && missing=$(missing_for "$@"); } ||
    stop "apt knows no way to install $*; the pinned version has to be one that Debian 12 offers"
  mkdir "$work/debs" "$work/root"
  # shellcheck disable=SC2086  # one word a package
  (cd "$work/debs" && apt-get -qq -o APT::Sandbox::User=root download "$@" $missing) ||
    stop "the packages $* could not be downloaded"
  for deb in "$work"/debs/*.deb; do dpkg -x "$deb" "$work/root"; done
}
missing_for() {
  apt-get --simulate install --no-install-recommends --allow-downgrades "$@" 2>/dev/null | awk '/^Inst/ { print $2 }'
}

# Corner normals: 60 degrees from the direction to the light, told apart by $1 in y.
normals() { echo "<0.8660254,0,-0.5> <0.8660254,$1,-0.5> <0.8660254,-$1,-0.5>"; }

# make_object KIND SPREAD prints one triangle that fills the view, in the plane z = 0.
make_object() {
  local a='<-5,-5,0>' b='<5,-5,0>' c='<0,5,0>' na nb nc
  read -r na nb nc < <(normals "$2")
  local triangle="smooth_triangle { $a,$na $b,$nb $c,$nc"
  case $1 in
    lone) echo "$triangle" ;;
    mesh) echo "mesh { $triangle }" ;;
    mesh2) echo "mesh2 { vertex_vectors { 3 $a $b $c } normal_vectors { 3 $na $nb $nc } face_indices { 1 <0,1,2> }" ;;
  esac
  echo "texture { pigment { rgb 1 } finish { ambient 0 diffuse 1 } } }"
}

# brightness_permille KIND SPREAD renders 3 by 3 pixels with linear 16 bit samples and prints the middle one.
brightness_permille() {
  local scene=$work/scene.pov image=$work/image.ppm high low
  {
    echo '#version 3.7; global_settings { assumed_gamma 1 ambient_light 0 }'
    echo 'camera { orthographic location <0,0,-5> look_at 0 right x*2 up y*2 }'
    echo 'light_source { <0,0,-1000000> rgb 1 parallel point_at 0 }'
    make_object "$1" "$2"
  } >"$scene"
  "$povray" +I"$scene" +O"$image" +FP16 File_Gamma=1 +W3 +H3 -D -A +WT1 >"$work/log" 2>&1 ||
    stop "POV-Ray refused the scene with $1: $(tail -n 3 "$work/log")"
  # Nine pixels of six bytes end the file; the fifth starts 30 bytes before the end.
  read -r high low < <(od -An -tu1 -j $(($(stat -c %s "$image") - 30)) -N 2 "$image")
  echo $(((high * 256 + low) * 1000 / 65535))
}

fetch_debian povray=1:3.7.0.10-2+b2
export LD_LIBRARY_PATH=$work/root/usr/lib/x86_64-linux-gnu
povray=$work/root/usr/bin/povray
echo "Version: $("$povray" --version 2>&1 | grep -m 1 -o 'POV-Ray 3[^ ]*')"
echo "Input: a white matt triangle square to the light, with corner normals tilted by 60 degrees."
echo "By the manual: brightness cos 60 = 0.500 in each row; 1.000 is what the normal of the plane gives."

failed=0
# check KIND SPREAD EXPECTED
check() {
  local seen
  seen=$(brightness_permille "$1" "$2")
  printf 'Seen: %-5s  normals differ by %-8s  brightness %d.%03d\n' "$1" "$2" $((seen / 1000)) $((seen % 1000))
  ((seen >= $3 - 2 && seen <= $3 + 2)) || failed=1
}
check lone 0 500
check mesh 0 1000
check mesh2 0 1000
check mesh2 0.000005 1000
check mesh2 0.001 500

((failed == 0)) || stop "a brightness is not the one stated at the top of this script"
echo "As stated: in a mesh, equal corner normals are dropped for the normal of the plane."

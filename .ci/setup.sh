# Sourced by samples/run.sh and tests/run.sh: installs what is missing and builds.
# Needs Debian 12 (or a system with the same packages); uses sudo when not root.

packages_build=(build-essential cmake ninja-build pkg-config git ccache gettext
  libboost-dev libopenmesh-dev libcgal-dev libeigen3-dev libembree-dev libtbb-dev libglm-dev
  libopenimageio-dev openimageio-tools libopencolorio-dev libtinygltf-dev libsqlite3-dev libsqlitecpp-dev
  libzstd-dev libpng-dev zlib1g-dev libxxhash-dev libpugixml-dev libfontconfig-dev libfreetype-dev libharfbuzz-dev libassimp-dev libocct-data-exchange-dev libdraco-dev libmeshoptimizer-dev libpodofo-dev libpolyclipping-dev libtomlplusplus-dev libcli11-dev libfmt-dev
  nlohmann-json3-dev libstb-dev libbenchmark-dev
  libglfw3-dev libxrandr-dev libxi-dev libimgui-dev libepoxy-dev libgl-dev libegl-dev libspnav-dev)
# What the tests are configured and compiled with, and what they only run.
packages_test=(libgtest-dev libgmock-dev liborocos-kdl-dev clang-format doxygen)
packages_run=(poppler-utils python3-ezdxf slurm-wlm munge parallel occt-misc gmsh-doc netgen-doc ffmpeg imagemagick lib3mf1 mandoc zsh appstream desktop-file-utils
  xvfb xauth xdotool libgl1-mesa-dri libegl1
  xserver-xorg-core xserver-xorg-video-dummy xserver-xorg-input-wacom umockdev)

say() { printf '\n== %s\n' "$*" >&2; }

install_missing() {
  command -v dpkg-query >/dev/null || { say "not a Debian system: please install ${*}"; return 0; }
  local missing=() sudo=()
  for package in "$@"; do
    [ "$(dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null)" = installed ] || missing+=("$package")
  done
  [ ${#missing[@]} -eq 0 ] && return 0
  [ "$(id -u)" -eq 0 ] || sudo=(sudo)
  say "installing ${missing[*]}"
  "${sudo[@]}" apt-get -o DPkg::Lock::Timeout=600 update -qq
  "${sudo[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -o DPkg::Lock::Timeout=600 \
    install -y -qq --no-install-recommends "${missing[@]}"
}

# build TARGET...: configures the release preset and builds.
build() {
  local log=build/configure.log flags=${CXXFLAGS:-}
  # GCC collects its garbage from 128 MB on, an eighth of its time (app's tests: 17.0 s, and 14.9): from a gigabyte on, few
  # sources do.
  case $("${CXX:-c++}" --version) in *"Free Software"*) flags+=" --param=ggc-min-heapsize=1000000" ;; esac
  mkdir -p build
  say "building (release)"
  CXXFLAGS=$flags cmake --preset release -DTUFT_UNITY=ON "${cmake_options[@]}" >"$log" 2>&1 || { cat "$log" >&2; return 1; }
  # A build from nothing finds nothing in the cache: depend mode saves running the preprocessor before each compilation.
  CCACHE_DEPEND=1 cmake --build --preset release --parallel "$(jobs_for_memory)" --target "$@" >&2
}

# A CGAL source takes 2 GB to compile: as many jobs as cores, but no more than memory allows.
jobs_for_memory() {
  local cores gib
  cores=$(nproc)
  gib=$(awk '/MemAvailable/ {print int($2 / 1048576)}' /proc/meminfo)
  local by_memory=$(( gib / 2 > 0 ? gib / 2 : 1 ))
  echo $(( cores < by_memory ? cores : by_memory ))
}

#!/usr/bin/env bash
# Installs what building and testing tessera needs: system packages, and newer Vulkan headers inside build/.
#
#   thirdparty/setup.sh           build and tests
#   thirdparty/setup.sh --all     also clang, clang-tidy and clang-format (for ./test.sh --all), a browser for the test of the report's page, and what
#                                 docs/reports/make.sh needs
#
# Debian 12 and 13 are installed for (as root or through sudo); elsewhere it says what is missing and how to get it.
# Safe to run twice; when everything is there it calls no package tool but a query and takes no time.
# Which package is there for what reason: thirdparty/README.md.
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
headers=$root/build/thirdparty/headers
header_version_wanted=307     # VK_HEADER_VERSION that has VK_NV_cluster_acceleration_structure
mesa_wanted=24                # first major version of lavapipe with all mesh shader features used here

build_packages=(build-essential cmake ninja-build ccache pkg-config patchelf
	libvulkan-dev libvulkan1 glslang-tools glslang-dev spirv-tools
	libtinygltf-dev libmeshoptimizer-dev libglm-dev libcli11-dev libspdlog-dev libfmt-dev libexpected-dev
	nlohmann-json3-dev libstb-dev libdraco-dev zlib1g-dev libembree-dev libglfw3-dev libimgui-dev)
run_packages=(librsvg2-bin)
test_packages=(libgtest-dev libgmock-dev vulkan-validationlayers assimp-testmodels
	xvfb xdotool imagemagick python3 python3-xlib)
all_packages=(clang clang-tidy clang-format libclang-rt-dev chromium glmark2-data assimp-utils)

say()  { echo "setup: $*"; }
stop() { echo "setup: $*" >&2; exit 1; }

# --- What is missing -------------------------------------------------------------------------------------------------

# Prints those of its arguments that are not installed packages.
missingPackages()
{
	local name status
	local -A installed=()
	while read -r name status
	do
		[[ $status == installed ]] && installed[${name%%:*}]=1
	done < <(dpkg-query -W -f '${Package} ${db:Status-Status}\n' "$@" 2>/dev/null || true)
	for name in "$@"
	do
		[[ -n ${installed[$name]:-} ]] || echo "$name"
	done
}

# True when the include folder $1 has new enough Vulkan headers.
hasNewHeaders()
{
	local line
	[[ -r $1/vulkan/vulkan_core.h ]] || return 1
	while read -r line
	do
		if [[ $line =~ ^'#define VK_HEADER_VERSION '([0-9]+) ]]
		then
			(( BASH_REMATCH[1] >= header_version_wanted ))
			return
		fi
	done < "$1/vulkan/vulkan_core.h"
	return 1
}

hasHeader() { [[ -r $headers/include/$1 || -r /usr/include/$1 || -r /usr/local/include/$1 ]]; }

headersComplete()
{
	{ hasNewHeaders "$headers/include" || hasNewHeaders /usr/include; } && hasHeader vk_mem_alloc.h
}

# True when a new enough Mesa (the software Vulkan driver that tests run on) is installed.
mesaFits()
{
	local version
	version=$(dpkg-query -W -f '${db:Status-Status} ${Version}\n' mesa-vulkan-drivers 2>/dev/null | head -n 1) || return 1
	[[ $version == "installed "* ]] || return 1
	version=${version#installed }
	version=${version#*:}
	(( ${version%%.*} >= mesa_wanted ))
}

# --- Where packages come from ----------------------------------------------------------------------------------------

# Prints "URI KEYRING" of the machine's own source for suite $1, component main ("-": no keyring named); nothing if none.
sourceOfSuite()
{
	local files=()
	local file
	for file in /etc/apt/sources.list /etc/apt/sources.list.d/*.list /etc/apt/sources.list.d/*.sources
	do
		[[ -r $file ]] && files+=("$file")
	done
	(( ${#files[@]} )) || return 0
	awk -v suite="$1" '
		function finishStanza()
		{
			if ((" " field["types"] " ") ~ / deb / && index(" " field["suites"] " ", " " suite " ") &&
				index(" " field["components"] " ", " main ") && tolower(field["enabled"]) != "no" && !found)
			{
				split(field["uris"], uris, " ")
				print uris[1], (field["signed-by"] ~ /^\// ? field["signed-by"] : "-")
				found = 1
			}
			delete field
		}
		FNR == 1 { finishStanza() }
		/^[ \t]*#/ { next }
		FILENAME ~ /\.sources$/ {
			if ($0 ~ /^[ \t]*$/) finishStanza()
			else if ($0 ~ /^[ \t]/) field[name] = field[name] " " $0
			else
			{
				name = tolower(substr($0, 1, index($0, ":") - 1))
				value = substr($0, index($0, ":") + 1)
				gsub(/^[ \t]+|[ \t]+$/, "", value)
				field[name] = value
			}
			next
		}
		$1 == "deb" {
			field["types"] = "deb"
			rest = $0
			sub(/^[ \t]*deb[ \t]+/, "", rest)
			if (match(rest, /^\[[^]]*\]/))
			{
				split(substr(rest, 2, RLENGTH - 2), options, " ")
				for (i in options)
					if (options[i] ~ /^signed-by=/) field["signed-by"] = substr(options[i], 11)
				rest = substr(rest, RLENGTH + 1)
			}
			split(rest, words, " ")
			field["uris"] = words[1]
			field["suites"] = words[2]
			sub(/^[ \t]*[^ \t]+[ \t]+[^ \t]+[ \t]*/, "", rest)
			field["components"] = rest
			finishStanza()
		}
		END { finishStanza() }' "${files[@]}"
}

# Prints a one-line source for suite $2, on the mirror from which this machine takes suite $1.
sourceLine()
{
	local uri keyring
	local archive_keyring=/usr/share/keyrings/debian-archive-keyring.gpg
	read -r uri keyring < <(sourceOfSuite "$1") ||
		stop "no package source for '$1 main' in /etc/apt; add one, then run this again"
	[[ $keyring == - && -r $archive_keyring ]] && keyring=$archive_keyring
	if [[ $keyring == - ]]
	then
		echo "deb $uri $2 main"
	else
		echo "deb [signed-by=$keyring] $uri $2 main"
	fi
}

# --- Installing ------------------------------------------------------------------------------------------------------

asRoot()
{
	if (( EUID == 0 ))
	then
		DEBIAN_FRONTEND=noninteractive "$@"
	else
		sudo DEBIAN_FRONTEND=noninteractive "$@"
	fi
}

needRoot()
{
	(( EUID == 0 )) || command -v sudo > /dev/null ||
		stop "installing packages needs root or sudo, and this is neither; as root, run: thirdparty/setup.sh"
}

# Installs packages $2.. of the suite $1 ("" for the machine's own choice).
aptInstall()
{
	local target=$1
	shift
	asRoot apt-get install -y -q --no-install-recommends ${target:+-t "$target"} "$@"
}

# Debian 12 only: Mesa with mesh shaders comes from the backports suite, nothing else does.
addBackports()
{
	local line
	[[ -n $(sourceOfSuite "$codename-backports") ]] && return
	line=$(sourceLine "$codename" "$codename-backports")
	say "adding the suite $codename-backports as /etc/apt/sources.list.d/tessera-backports.list"
	asRoot tee /etc/apt/sources.list.d/tessera-backports.list <<< "$line" > /dev/null
}

# Debian 12 only: unpacks the next Debian's Vulkan and VMA headers (no library of it) into build/thirdparty/headers.
# The list, state and cache of this download live in build/: the machine's package state is not touched.
unpackNewerHeaders()
{
	local apt=$root/build/thirdparty/apt
	local options deb
	say "unpacking the Vulkan and VMA headers of Debian 13 into build/thirdparty/headers"
	rm -rf "$apt" "$headers"
	mkdir -p "$apt/lists/partial" "$apt/cache/archives/partial" "$apt/debs" "$headers"
	: > "$apt/status"
	sourceLine "$codename" trixie > "$apt/sources.list"
	options=(-q -o Dir::Etc::SourceList="$apt/sources.list" -o Dir::Etc::SourceParts=/dev/null
		-o Dir::Etc::Preferences=/dev/null -o Dir::Etc::PreferencesParts=/dev/null
		-o Dir::State::Lists="$apt/lists" -o Dir::State::status="$apt/status" -o Dir::Cache="$apt/cache"
		-o Debug::NoLocking=1 -o APT::Sandbox::User="$(id -un)" -o Acquire::Languages=none)
	(
		cd "$apt/debs"
		apt-get "${options[@]}" update
		apt-get "${options[@]}" download libvulkan-dev libvulkan-memory-allocator-dev
		for deb in *.deb
		do
			dpkg -x "$deb" "$apt/unpacked"
		done
	)
	mkdir -p "$headers/include"
	mv "$apt/unpacked/usr/include/"{vulkan,vk_video,vk_mem_alloc.h} "$headers/include/"
	rm -rf "$apt"
	headersComplete || stop "the headers downloaded are older than VK_HEADER_VERSION $header_version_wanted"
}

setUpDebian()
{
	local wanted=("${build_packages[@]}" "${run_packages[@]}" "${test_packages[@]}")
	local missing mesa_missing=0 mesa_suite=""
	(( version >= 13 )) && wanted+=(libvulkan-memory-allocator-dev)
	(( with_all )) && wanted+=("${all_packages[@]}")
	mapfile -t missing < <(missingPackages "${wanted[@]}")
	mesaFits || mesa_missing=1

	if (( ${#missing[@]} || mesa_missing ))
	then
		(( ${#missing[@]} )) && say "will install these packages and what they depend on: ${missing[*]}"
		(( mesa_missing )) && say "will install mesa-vulkan-drivers (>= $mesa_wanted) for its software Vulkan driver"
		needRoot
		(( mesa_missing && version == 12 )) && addBackports
		asRoot apt-get update -q
		(( ${#missing[@]} )) && aptInstall "" "${missing[@]}"
		(( version == 12 )) && mesa_suite=$codename-backports
		(( mesa_missing )) && aptInstall "$mesa_suite" mesa-vulkan-drivers
	fi
	headersComplete || unpackNewerHeaders
	say "everything is there"
}

# --- Other systems: say what is missing ------------------------------------------------------------------------------

reportOnly()
{
	local tool header missing=()
	for tool in c++ cmake ninja glslangValidator spirv-val
	do
		command -v "$tool" > /dev/null || missing+=("$tool")
	done
	for header in vulkan/vulkan.h vk_mem_alloc.h tiny_gltf.h meshoptimizer.h glm/glm.hpp CLI/CLI.hpp spdlog/spdlog.h \
		fmt/format.h tl/expected.hpp nlohmann/json.hpp stb/stb_image.h draco/draco_features.h zlib.h gtest/gtest.h \
		GLFW/glfw3.h imgui/imgui.h
	do
		[[ -r ${VULKAN_SDK:-/nowhere}/include/$header ]] || hasHeader "$header" || missing+=("$header")
	done
	hasHeader embree3/rtcore.h || hasHeader embree4/rtcore.h || missing+=(embree4/rtcore.h)
	if (( ${#missing[@]} == 0 ))
	then
		say "everything is there"
		return
	fi
	say "this system (${system_name}) is not one that is installed for; missing: ${missing[*]}" >&2
	say "get Vulkan, VMA, glslang and SPIRV-Tools from the Vulkan SDK (set VULKAN_SDK) and the rest from your packages" >&2
	say "under Debian's names these are: ${build_packages[*]} ${run_packages[*]} libvulkan-memory-allocator-dev ${test_packages[*]}" >&2
	say "(on Ubuntu 24.04 and later apt-get install takes that list, with mesa-vulkan-drivers)" >&2
	exit 1
}

# --- Start -----------------------------------------------------------------------------------------------------------

with_all=0
case ${1:-} in
	"") ;;
	--all) with_all=1 ;;
	*) stop "unknown argument '$1'; usage: thirdparty/setup.sh [--all]" ;;
esac

system_name="an unknown system" version=0 codename=""
if [[ -r /etc/os-release ]]
then
	# shellcheck disable=SC1091
	system_name=$(. /etc/os-release && echo "${PRETTY_NAME:-$ID}")
	read -r id version codename < <(. /etc/os-release && echo "${ID:-none} ${VERSION_ID:-0} ${VERSION_CODENAME:-none}")
	[[ $id == debian && $version == 1[23] ]] && { setUpDebian; exit; }
fi
reportOnly

# shellcheck shell=bash
# What tools/test and tools/demo need of a fresh Debian or Ubuntu machine. Source it, then call
# the vtex_need_* functions; each says what it does, does nothing twice, and returns non-zero with
# a line on stderr when it cannot help.

vtex_say() {
    printf '==> %s\n' "$*"
}

vtex_fail() {
    printf 'error: %s\n' "$*" >&2
    return 1
}

# Installs Debian packages, as root or through sudo.
vtex_apt_install() {
    if ! command -v apt-get >/dev/null; then
        vtex_fail "no apt-get here; install by hand: $*"
        return 1
    fi
    local as_root=()
    if [ "$(id -u)" -ne 0 ]; then
        if ! command -v sudo >/dev/null; then
            vtex_fail "neither root nor sudo; install by hand: $*"
            return 1
        fi
        as_root=(sudo)
    fi
    vtex_say "apt-get install $*"
    # A stale list knows packages that the mirror no longer has; a fresh machine has no list.
    "${as_root[@]}" apt-get update -qq || vtex_say "apt-get update failed, trying with the old lists"
    "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive \
        apt-get install -y -qq --no-install-recommends "$@" >/dev/null
}

# Rust with the components that the checks use.
vtex_need_rust() {
    if ! command -v cargo >/dev/null && [ -f "$HOME/.cargo/env" ]; then
        # shellcheck source=/dev/null
        . "$HOME/.cargo/env"
    fi
    if ! command -v cargo >/dev/null; then
        vtex_fail "no cargo; install Rust from https://rustup.rs"
        return 1
    fi
    local component
    for component in fmt clippy; do
        if ! cargo "$component" --version >/dev/null 2>&1; then
            vtex_say "rustup component add ${component/fmt/rustfmt}"
            rustup component add "${component/fmt/rustfmt}"
        fi
    done
}

# The standard library that the check for browsers compiles against.
vtex_need_wasm() {
    local target=wasm32-unknown-unknown
    if [ -d "$(rustc --print target-libdir --target "$target")" ]; then
        return 0
    fi
    if ! command -v rustup >/dev/null; then
        vtex_fail "no rustup to fetch $target with; install it with what installed Rust"
        return 1
    fi
    vtex_say "rustup target add $target"
    if ! rustup target add "$target"; then
        vtex_fail "cannot fetch $target; run again with a network"
        return 1
    fi
}

# A C compiler: zstd-sys compiles libzstd.
vtex_need_compiler() {
    if ! command -v cc >/dev/null && ! command -v gcc >/dev/null; then
        vtex_apt_install gcc libc6-dev
    fi
}

# A Vulkan loader and an adapter, in software when there is no other. VTEX_GPU=off does without.
vtex_need_vulkan() {
    if [ "${VTEX_GPU:-}" = off ] || [ "$(uname -s)" != Linux ]; then
        return 0
    fi
    # Mesa's window system code complains on stderr where this is not set, windows or not.
    export XDG_RUNTIME_DIR=${XDG_RUNTIME_DIR:-${TMPDIR:-/tmp}}
    if vtex_has_vulkan; then
        return 0
    fi
    vtex_apt_install mesa-vulkan-drivers libvulkan1
    if ! vtex_has_vulkan; then
        vtex_fail "still no Vulkan adapter; VTEX_GPU=off does without"
        return 1
    fi
}

# Whether a Vulkan driver is registered and its loader can be found.
vtex_has_vulkan() {
    local loader driver
    loader=$(PATH="$PATH:/sbin:/usr/sbin" ldconfig -p 2>/dev/null | grep -c 'libvulkan\.so\.1' || true)
    if [ "${loader:-0}" -eq 0 ]; then
        return 1
    fi
    if [ -n "${VK_ICD_FILENAMES:-}${VK_DRIVER_FILES:-}" ]; then
        return 0
    fi
    for driver in /usr/share/vulkan/icd.d/*.json /etc/vulkan/icd.d/*.json; do
        if [ -e "$driver" ]; then
            return 0
        fi
    done
    return 1
}

# cargo-deny, built from source when it is missing: about two minutes.
vtex_need_cargo_deny() {
    if ! cargo deny --version >/dev/null 2>&1; then
        vtex_say "cargo install cargo-deny --locked"
        cargo install cargo-deny --locked --quiet
    fi
}

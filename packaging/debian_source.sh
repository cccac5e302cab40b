# Sourced by scripts/package: source packages of Debian, for libraries that the portable wheels link statically.

# fetch_source PACKAGE FILE SHA256: a binary package's source archive, from this machine's own mirror, in build/portable.
fetch_source() {
    local folder
    if [ ! -e "$portable/$2" ]; then
        folder=$(apt-get download --print-uris "$1" 2>/dev/null | sed -n "s/^'\(.*\/\)[^/]*' .*/\1/p")
        [ -n "$folder" ] || fail "apt-get does not say where $1 comes from: run 'apt-get update'"
        /usr/lib/apt/apt-helper download-file "$folder$2" "$portable/$2" >"$portable/$1_fetch.log" 2>&1 ||
            { tail -n 5 "$portable/$1_fetch.log" >&2; fail "could not fetch $2; put it into $portable by hand"; }
    fi
    sha256sum --check --status <<<"$3  $portable/$2" || fail "$portable/$2 does not have the expected SHA-256 digest, $3"
}

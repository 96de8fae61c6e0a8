# The viewer in the repository is what its sources make, with the libraries of the lock file. Skipped
# (77) without Node.js or without a registry (or cache) to fetch them from.
set -eu
report=$1
command -v npm >/dev/null 2>&1 || { echo "no npm"; exit 77; }
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
if grep -q '"resolved"' "$report/viewer/package-lock.json"; then
    echo "FAILED: the lock file names a registry"
    exit 1
fi
mkdir "$scratch/viewer"
cd "$report/viewer"
cp -R package.json package-lock.json .npmrc build.mjs src "$scratch/viewer"
cd "$scratch/viewer"
npm ci --ignore-scripts --prefer-offline --silent >npm.log 2>&1 || {
    echo "npm ci fails: $(tail -n 3 npm.log)"
    exit 77
}
npm run --silent build
cmp "$scratch/viewer.html" "$report/viewer.html"

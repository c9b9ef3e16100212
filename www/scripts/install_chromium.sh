#!/usr/bin/env bash
# Sees to a Chromium for the page's tests: the one that CHROMIUM names, the system's, Debian's package
# when run as root there, or else the browser that Playwright downloads.
set -euo pipefail
cd "$(dirname "$0")/.."

# Ubuntu calls itself a Debian too, but has no such package: Playwright's browser serves there.
debian_has_it() {
    [ "$(id -u)" = 0 ] && [ -f /etc/debian_version ] || return 1
    apt-cache show chromium >/dev/null 2>&1 || apt-get update || return 1
    apt-cache show chromium >/dev/null 2>&1
}

if [ -n "${CHROMIUM:-}" ]; then
    [ -x "$CHROMIUM" ] || { echo "CHROMIUM=$CHROMIUM is not a program" >&2; exit 1; }
elif command -v chromium >/dev/null; then
    echo "Chromium: $(command -v chromium)"
elif debian_has_it; then
    DEBIAN_FRONTEND=noninteractive apt-get install -y --no-install-recommends chromium fonts-dejavu-core
else
    npx playwright install chromium
fi

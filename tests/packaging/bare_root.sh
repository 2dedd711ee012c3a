# To be sourced: installs Debian packages by dpkg in a bare root. The root has what the packages depend on and nothing
# else, copied from this machine: a dependency that is not declared is missing there.
skip() { echo "$1"; exit 77; }
[ "$(id -u)" = 0 ] || skip "only root may chroot"
[[ ${3:-} != *-fsanitize* ]] || skip "sanitizers need /proc, which the bare root lacks"
command -v dpkg-query >/dev/null || skip "no dpkg: not a Debian"
room=$(mktemp -d)
trap 'rm -rf "$room"' EXIT
root=$room/root

# usage: install_in_bare_root NAME_OR_DEB...     names: packages of this machine that the root has besides
install_in_bare_root() {
  local debs=()
  for word; do [[ $word != *.deb ]] || debs+=("$word"); done
  list_of_files "$room/closure" "$@" || skip "this machine lacks packages that they depend on"
  mkdir -p "$root"/{usr/{bin,sbin,lib,lib64},etc,tmp,dev,proc,var/lib/dpkg/{info,updates,triggers}}
  for folder in bin sbin lib lib64; do ln -s "usr/$folder" "$root/$folder"; done
  tar --create --directory=/ --no-recursion --files-from="$room/closure.files" | tar --extract --directory="$root"
  while read -r file link; do ln -sf "$file" "$root$link"; done <"$room/closure.links"
  xargs dpkg-query -s <"$room/closure.names" >"$root/var/lib/dpkg/status"
  touch "$root/var/lib/dpkg/available"
  ldconfig -r "$root"
  dpkg --root="$root" --log="$room/dpkg.log" --install "${debs[@]}" 2>&1 | grep -v 'files list file'
}
inside() { env -i PATH=/usr/sbin:/usr/bin HOME=/tmp LANG=C.UTF-8 chroot "$root" "$@"; }

# Writes FILE.names, FILE.files and FILE.links: the packages, their files, and links of alternatives.
list_of_files() {
  /usr/bin/python3 - "$@" <<'END'
import os, re, subprocess, sys

def output(*words):
    return subprocess.run(words, capture_output=True, encoding="utf-8", check=True).stdout

depends, provider = {}, {}
columns = "${db:Status-Abbrev}\t${Package}\t${Provides}\t${Depends}, ${Pre-Depends}\n"
for line in output("dpkg-query", "-W", "-f", columns).splitlines():
    status, name, provides, needed = line.split("\t")
    if not status.startswith("ii"):
        continue
    depends[name] = needed
    for other in [name, *re.findall(r"(?:^|, )([^ ,(]+)", provides)]:
        provider.setdefault(other, name)
debs = [word for word in sys.argv[2:] if word.endswith(".deb")]
ours, waiting = set(), ["base-files", "coreutils", "dash", "libc-bin", *(set(sys.argv[2:]) - set(debs))]
for deb in debs:
    ours.add(output("dpkg-deb", "--field", deb, "Package").strip())
    waiting += [output("dpkg-deb", "--field", deb, "Depends").strip()]
wanted = set()
while waiting:
    for group in filter(str.strip, waiting.pop().split(",")):
        names = [re.match(r"\s*([^ :(]+)", one)[1] for one in group.split("|")]
        found = next((provider[name] for name in names if name in provider and name not in ours), None)
        if found is None and not ours & set(names):
            sys.exit(f"not installed here: {group.strip()}")
        if found and found not in wanted:
            wanted.add(found)
            waiting.append(depends[found])
files = {one for one in output("dpkg-query", "-L", *wanted).splitlines() if os.path.islink(one) or os.path.isfile(one)}
# The links of alternatives belong to no package, and may lead to one that the root does not have.
links = []
for folder in ("/usr/bin", "/usr/lib/" + output("dpkg-architecture", "-qDEB_HOST_MULTIARCH").strip()):
    for one in os.scandir(folder):
        if not one.is_symlink() or os.path.dirname(os.readlink(one.path)) != "/etc/alternatives":
            continue
        name = os.path.basename(os.readlink(one.path))
        known = subprocess.run(["update-alternatives", "--query", name], capture_output=True, encoding="utf-8",
                               check=False)
        offered = [os.path.realpath(one.path), *re.findall("^Alternative: (.*)$", known.stdout, re.M)]
        offered = [other for other in offered if {other, os.path.realpath(other)} & files]
        links += [f"{other} {one.path}\n" for other in offered[:1]]
with open(sys.argv[1] + ".links", "w") as out:
    out.writelines(links)
unused = re.compile("/usr/share/(doc|locale|man|icons|fonts)/")
with open(sys.argv[1] + ".files", "w") as out:
    out.writelines(one[1:] + "\n" for one in sorted(files) if not unused.match(one))
with open(sys.argv[1] + ".names", "w") as out:
    out.writelines(one + "\n" for one in sorted(wanted))
END
}

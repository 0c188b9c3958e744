"""Fetches what the virtual machine of the tests boots: Debian's kernel, and v4l2loopback built for it.

Nothing is installed: packages are downloaded by apt-get and unpacked into a folder, once.
"""

import fcntl
import pathlib
import re
import shutil
import subprocess

TOOLS = ["apt-get", "apt-cache", "dpkg-deb", "qemu-system-x86_64", "busybox", "cpio", "make", "gcc"]


class Unavailable(Exception):
    """This machine cannot run the virtual machine; the text says why."""


def run(*command, cwd=None):
    """Runs a command of the preparation; its output goes into the exception if it fails."""
    done = subprocess.run([str(word) for word in command], cwd=cwd, text=True,
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    if done.returncode != 0:
        raise Unavailable(f"{' '.join(map(str, command))} failed:\n{done.stdout[-2000:]}")
    return done.stdout


def kernel_package():
    missing = [tool for tool in TOOLS if shutil.which(tool) is None]
    if missing:
        raise Unavailable(f"not installed: {', '.join(missing)} (scripts/install_deps.sh --tests)")
    found = re.search(r"Depends: (linux-image-\S+)", run("apt-cache", "depends", "linux-image-amd64"))
    if not found:
        raise Unavailable("apt knows no linux-image-amd64; run apt-get update")
    return found.group(1)


def download(packages, folder):
    """Downloads and unpacks packages into folder/root."""
    folder.mkdir(parents=True, exist_ok=True)
    run("apt-get", "-q", "-o", "Acquire::Retries=3", "download", *packages, cwd=folder)
    for deb in sorted(folder.glob("*.deb")):
        run("dpkg-deb", "-x", deb, folder / "root")
        deb.unlink()


def build_loopback(version, folder):
    """Builds v4l2loopback.ko from Debian's source against the kernel's headers."""
    abi = version.removesuffix("-amd64")
    download([f"linux-headers-{version}", f"linux-headers-{abi}-common",
              f"linux-kbuild-{'.'.join(version.split('.')[:2])}", "v4l2loopback-dkms"], folder)
    sources = folder / "root/usr/src"
    headers = sources / f"linux-headers-{version}"
    makefile = headers / "Makefile"
    makefile.write_text(makefile.read_text().replace("/usr/src/", f"{sources}/"))
    module = next(sources.glob("v4l2loopback-*"))
    run("make", "-s", f"KERNELRELEASE={version}", "-C", headers, f"M={module}", "modules")
    return module / "v4l2loopback.ko"


class DebianKernel:
    """A kernel image and its modules below `folder`; prepared by the first who asks."""

    def __init__(self, folder):
        package = kernel_package()
        self.version = package.removeprefix("linux-image-")
        self.folder = pathlib.Path(folder).resolve() / self.version
        self.folder.mkdir(parents=True, exist_ok=True)
        with open(self.folder / "lock", "w", encoding="utf-8") as lock:
            fcntl.flock(lock, fcntl.LOCK_EX)
            if not (self.folder / "complete").exists():
                self._prepare(package)
        self.image = self.folder / f"kernel/root/boot/vmlinuz-{self.version}"

    def _prepare(self, package):
        for part in ("kernel", "loopback"):
            shutil.rmtree(self.folder / part, ignore_errors=True)
        download([package], self.folder / "kernel")
        built = build_loopback(self.version, self.folder / "loopback")
        shutil.copy(built, self.folder / "v4l2loopback.ko")
        shutil.rmtree(self.folder / "loopback")
        (self.folder / "complete").touch()

    def modules(self, names):
        """Lists the files of modules and of all that they need, in the order of loading."""
        tree = self.folder / "kernel/root/lib/modules" / self.version
        files = {path.stem: path for path in tree.rglob("*.ko")}
        files["v4l2loopback"] = self.folder / "v4l2loopback.ko"
        ordered = []

        def add(name):
            if name not in files:
                raise Unavailable(f"kernel {self.version} has no module {name}")
            depends = re.search(rb"\0depends=([^\0]*)\0", files[name].read_bytes())
            for other in filter(None, depends.group(1).decode().split(",") if depends else []):
                add(other.replace("-", "_") if other.replace("-", "_") in files else other)
            if files[name] not in ordered:
                ordered.append(files[name])

        for name in names:
            add(name)
        return ordered

"""Runs a command in a virtual machine that has video devices.

The machine is emulated (no KVM) and boots Debian's kernel; its programs are this machine's own: the
root file system is shared read-only, /mnt is a folder for results.
"""

import pathlib
import re
import shutil
import subprocess

from debian_kernel import Unavailable, run

MEMORY_MIB = 2048

INIT = """#!/bin/busybox sh
export PATH=/bin
/bin/busybox --install -s /bin
mount -t proc proc /proc; mount -t sysfs sys /sys; mount -t devtmpfs dev /dev
while read -r module; do insmod $module || echo "NOT LOADED: $module"; done < /modules
share=trans=virtio,version=9p2000.L,msize=1048576
mount -t 9p -o $share,cache=loose,ro host /host
mount -t devtmpfs dev /host/dev; mount -t proc proc /host/proc; mount -t sysfs sys /host/sys
mkdir -p /host/dev/shm && mount -t tmpfs shm /host/dev/shm
mount -t 9p -o $share results /host/mnt
ip link set lo up
echo "STARTED after $(cut -d' ' -f1 /proc/uptime) s"
chroot /host /bin/bash /mnt/command.sh
echo "EXIT_CODE=$?"
echo "ENDED after $(cut -d' ' -f1 /proc/uptime) s"
poweroff -f
"""


def initial_ram_disk(kernel, modules, folder):
    """Packs busybox, the modules {name: arguments} and INIT; returns the file."""
    tree = folder / "initrd"
    shutil.rmtree(tree, ignore_errors=True)
    for name in ("bin", "lib", "proc", "sys", "dev", "host"):
        (tree / name).mkdir(parents=True)
    shutil.copy(shutil.which("busybox"), tree / "bin/busybox")
    lines = []
    for file in kernel.modules(modules):
        shutil.copy(file, tree / "lib")
        lines.append(f"/lib/{file.name} {modules.get(file.stem, '')}\n")
    (tree / "modules").write_text("".join(lines))
    (tree / "init").write_text(INIT)
    (tree / "init").chmod(0o755)
    packed = folder / "initrd.cpio"
    with open(packed, "wb") as file:
        names = "\n".join(str(path.relative_to(tree)) for path in sorted(tree.rglob("*")))
        subprocess.run(["cpio", "-o", "-H", "newc", "--quiet"], cwd=tree, input=names.encode(),
                       stdout=file, check=True)
    return packed


def run_in_machine(kernel, modules, script, folder, timeout_s):
    """Runs a bash script with the modules {name: arguments} loaded; /mnt is `folder`.

    Returns (exit code or None, what the console showed).
    """
    folder = pathlib.Path(folder).resolve()
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "command.sh").write_text(script)
    wanted = {"virtio_pci": "", "9pnet_virtio": "", "9p": "", **modules}
    command = [
        "qemu-system-x86_64", "-accel", "tcg,thread=multi", "-cpu", "max", "-smp", "2",
        "-m", str(MEMORY_MIB), "-display", "none", "-nodefaults", "-no-reboot", "-serial", "stdio",
        "-kernel", str(kernel.image),
        "-initrd", str(initial_ram_disk(kernel, wanted, folder)),
        "-append", "console=ttyS0 quiet panic=-1 mitigations=off",
        "-virtfs", "local,path=/,mount_tag=host,security_model=none,readonly=on,multidevs=remap",
        "-virtfs", f"local,path={folder},mount_tag=results,security_model=none"]
    with open(folder / "console.log", "wb") as log:
        try:
            subprocess.run(command, stdin=subprocess.DEVNULL, stdout=log, stderr=subprocess.STDOUT,
                           timeout=timeout_s, check=False)
        except subprocess.TimeoutExpired:
            log.write(f"\nstopped after {timeout_s} s\n".encode())
    console = (folder / "console.log").read_text(errors="replace")
    code = re.search(r"EXIT_CODE=(\d+)", console)
    return (int(code.group(1)) if code else None), console


__all__ = ["Unavailable", "run", "run_in_machine"]

"""Makes a wheel of the module with CMake (PEP 517), so that `pip install .` needs nothing but what the build does."""

import base64
import hashlib
import os
import pathlib
import subprocess
import sys
import sysconfig
import zipfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
NAME = "relume"


def _version():
    for line in (ROOT / "pyproject.toml").read_text().splitlines():
        if line.startswith("version"):
            return line.split('"')[1]
    raise RuntimeError("pyproject.toml: no version")


def _build():
    folder = ROOT / "build-python"
    jobs = str(os.cpu_count() or 1)
    subprocess.check_call(["cmake", "-S", ROOT, "-B", folder, "-DCMAKE_BUILD_TYPE=Release", "-DRELUME_TESTS=OFF",
                           f"-DPython3_EXECUTABLE={sys.executable}"])
    subprocess.check_call(["cmake", "--build", folder, "--target", "relume_python", "--parallel", jobs])
    return folder / "python" / NAME


def get_requires_for_build_wheel(config_settings=None):
    return []


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    built = _build()
    version = _version()
    tag = f"cp{sys.version_info[0]}{sys.version_info[1]}"
    platform = sysconfig.get_platform().replace("-", "_").replace(".", "_")
    info = f"{NAME}-{version}.dist-info"
    files = {f"{NAME}/{path.relative_to(built)}": path.read_bytes() for path in sorted(built.rglob("*"))
             if path.is_file() and path.parent.name != "__pycache__"}
    files[f"{info}/METADATA"] = (f"Metadata-Version: 2.1\nName: {NAME}\nVersion: {version}\n"
                                 "License: Apache-2.0\nRequires-Dist: numpy\nProvides-Extra: laboratory\n"
                                 "Requires-Dist: matplotlib; extra == \"laboratory\"\n"
                                 "Requires-Dist: jinja2; extra == \"laboratory\"\n").encode()
    files[f"{info}/WHEEL"] = ("Wheel-Version: 1.0\nGenerator: relume\nRoot-Is-Purelib: false\n"
                              f"Tag: {tag}-{tag}-{platform}\n").encode()
    record = f"{info}/RECORD"
    lines = []
    for name, content in files.items():
        digest = base64.urlsafe_b64encode(hashlib.sha256(content).digest()).rstrip(b"=").decode()
        lines.append(f"{name},sha256={digest},{len(content)}")
    files[record] = ("\n".join(lines) + f"\n{record},,\n").encode()
    wheel = f"{NAME}-{version}-{tag}-{tag}-{platform}.whl"
    with zipfile.ZipFile(os.path.join(wheel_directory, wheel), "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in files.items():
            archive.writestr(name, content)
    return wheel


def build_sdist(sdist_directory, config_settings=None):
    name = f"{NAME}-{_version()}"
    subprocess.check_call(["git", "archive", "--format=tar.gz", f"--prefix={name}/",
                           "-o", os.path.join(sdist_directory, f"{name}.tar.gz"), "HEAD"], cwd=ROOT)
    return f"{name}.tar.gz"

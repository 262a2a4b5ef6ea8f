// Makes files fail at a chosen call: part of a library for LD_PRELOAD, set by environment variables.
// RELUME_FAULT_PATH  text that paths of affected files contain
// RELUME_FAULT       full (ENOSPC), short (half is written, and the next write is full), kill (SIGKILL
//                    instead of the call), unreadable (EIO)
// RELUME_FAULT_CALL  number of the call that fails, from 1, among write, pwrite, fsync, fdatasync and rename
//                    on such files; if unreadable, among open, fopen, read and pread. All later calls fail,
//                    too
#include "tests/support/faults.h"

#include <atomic>
#include <cerrno>
#include <climits>
#include <csignal>
#include <cstdarg>
#include <cstdio>
#include <cstring>
#include <fcntl.h>
#include <string>
#include <unistd.h>

using namespace relume::test;

namespace {

std::atomic<int> gCalls = 0;

bool concerns(const char* path) {
    const char* part = std::getenv("RELUME_FAULT_PATH");
    return part && std::strstr(path, part);
}

bool concerns(int file) {
    char path[PATH_MAX] = "";
    const std::string link = "/proc/self/fd/" + std::to_string(file);
    const ssize_t length = readlink(link.c_str(), path, sizeof path - 1);
    return length > 0 && concerns(path);
}

enum class Fault { None, Full, Short };

bool isUnreadable(const char* kind) { return !std::strcmp(kind, "unreadable"); }

// Counts a call that writes and returns how it fails. Does not return from the call that is to be killed.
Fault faultOf(bool isWrite) {
    const char* kind = std::getenv("RELUME_FAULT");
    if (!kind || isUnreadable(kind)) return Fault::None;
    const int call = ++gCalls, chosen = number("RELUME_FAULT_CALL");
    if (call < chosen) return Fault::None;
    if (!std::strcmp(kind, "kill")) raise(SIGKILL);
    if (!std::strcmp(kind, "short") && isWrite && call == chosen) return Fault::Short;
    return Fault::Full;
}

// Counts a call that reads and returns whether it fails.
bool readFails() {
    const char* kind = std::getenv("RELUME_FAULT");
    if (!kind || !isUnreadable(kind) || ++gCalls < number("RELUME_FAULT_CALL")) return false;
    errno = EIO;
    return true;
}

} // namespace

extern "C" {

int open(const char* path, int flags, ...) {
    static const auto real = next<int(const char*, int, mode_t)>("open");
    va_list rest;
    va_start(rest, flags);
    const mode_t mode = flags & (O_CREAT | O_TMPFILE) ? va_arg(rest, mode_t) : 0;
    va_end(rest);
    if ((flags & O_ACCMODE) == O_RDONLY && concerns(path) && readFails()) return -1;
    return real(path, flags, mode);
}

FILE* fopen(const char* path, const char* mode) {
    static const auto real = next<FILE*(const char*, const char*)>("fopen");
    if (*mode == 'r' && concerns(path) && readFails()) return nullptr;
    return real(path, mode);
}

// As the standard library's streams open files.
FILE* fopen64(const char* path, const char* mode) { return fopen(path, mode); }

ssize_t read(int file, void* bytes, size_t count) {
    static const auto real = next<ssize_t(int, void*, size_t)>("read");
    if (concerns(file) && readFails()) return -1;
    return real(file, bytes, count);
}

ssize_t pread(int file, void* bytes, size_t count, off_t offset) {
    static const auto real = next<ssize_t(int, void*, size_t, off_t)>("pread");
    if (concerns(file) && readFails()) return -1;
    return real(file, bytes, count, offset);
}

ssize_t write(int file, const void* bytes, size_t count) {
    static const auto real = next<ssize_t(int, const void*, size_t)>("write");
    const Fault fault = concerns(file) ? faultOf(true) : Fault::None;
    if (fault == Fault::Full) return errno = ENOSPC, -1;
    return real(file, bytes, fault == Fault::Short ? (count + 1) / 2 : count);
}

ssize_t pwrite(int file, const void* bytes, size_t count, off_t offset) {
    static const auto real = next<ssize_t(int, const void*, size_t, off_t)>("pwrite");
    const Fault fault = concerns(file) ? faultOf(true) : Fault::None;
    if (fault == Fault::Full) return errno = ENOSPC, -1;
    return real(file, bytes, fault == Fault::Short ? (count + 1) / 2 : count, offset);
}

int fsync(int file) {
    static const auto real = next<int(int)>("fsync");
    if (concerns(file) && faultOf(false) != Fault::None) return errno = EIO, -1;
    return real(file);
}

int fdatasync(int file) {
    static const auto real = next<int(int)>("fdatasync");
    if (concerns(file) && faultOf(false) != Fault::None) return errno = EIO, -1;
    return real(file);
}

int rename(const char* from, const char* to) {
    static const auto real = next<int(const char*, const char*)>("rename");
    if (concerns(to) && faultOf(false) != Fault::None) return errno = ENOSPC, -1;
    return real(from, to);
}

} // extern "C"

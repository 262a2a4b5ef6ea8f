// A library to preload into a program. Ten times a second it appends a line to the file that the environment
// variable RELUME_MEMORY_LOG names: the bytes of the heap in use, the resident bytes, which include freed
// memory that malloc keeps and what drivers map, and the number of open files.
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <malloc.h>
#include <thread>
#include <unistd.h>

namespace {

void watch(const char* path) {
    std::ofstream file(path);
    for (;;) {
        const struct mallinfo2 heap = mallinfo2();
        size_t pages = 0, residentPages = 0;
        std::ifstream("/proc/self/statm") >> pages >> residentPages;
        const std::filesystem::directory_iterator files("/proc/self/fd");
        file << heap.uordblks + heap.hblkhd << " " << residentPages * size_t(sysconf(_SC_PAGESIZE)) << " "
             << std::distance(begin(files), end(files)) << std::endl;
        std::this_thread::sleep_for(std::chrono::milliseconds(100));
    }
}

// The thread is never joined: it ends with the program.
const bool kIsWatched = [] {
    const char* path = std::getenv("RELUME_MEMORY_LOG");
    if (path) std::thread(watch, path).detach();
    return path != nullptr;
}();

} // namespace

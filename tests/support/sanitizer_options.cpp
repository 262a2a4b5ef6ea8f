// Part of programs with the address sanitizer.
extern "C" {

// Tests preload libraries that make calls fail, which then come before the sanitizer's own.
const char* __asan_default_options() { return "verify_asan_link_order=0"; }

// The validation layer, of version 1.3.239, frees little of what it allocates. What a driver holds for an
// object that is left, validation tells; a test leaves one on purpose. OpenEXR loses parts of a header when
// memory runs out among them.
const char* __lsan_default_suppressions() {
    return "leak:libVkLayer_khronos_validation\nleak:libvulkan_lvp\nleak:libOpenEXR\n";
}

// Tests read what programs say on stderr, and take any word of validation for its message.
const char* __lsan_default_options() { return "print_suppressions=0"; }

// Keeps libraries loaded: what an unloaded driver still holds can be neither found nor named, and would be a
// leak.
int dlclose(void*) { return 0; }

} // extern "C"

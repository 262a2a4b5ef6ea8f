#include "apps/viewer/shader_compiler.h"

#include "engine/base/error.h"
#include "engine/base/file.h"
#include "engine/vk/shader_replacement.h"
#include "shaders/frame_shaders.h"

#include <cstdlib>
#include <fmt/core.h>
#include <memory>

#ifdef RELUME_GLSLANG
#include <glslang/Public/ResourceLimits.h>
#include <glslang/Public/ShaderLang.h>
#include <glslang/SPIRV/GlslangToSpv.h>
#include <sstream>
#endif

namespace relume {

std::filesystem::path shaderFolder() {
    const char* folder = std::getenv("RELUME_SHADERS");
    return folder && *folder ? folder : RELUME_SHADERS;
}

#ifdef RELUME_GLSLANG

namespace {

constexpr size_t kMostBytes = 1 << 20; // per source
constexpr size_t kMostNested = 32;     // depth of includes

std::string readText(const std::filesystem::path& path) {
    const std::vector<std::byte> bytes = readFile(path, kMostBytes);
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

// Finds includes next to the including file, then from the root.
class Includer : public glslang::TShader::Includer {
  public:
    explicit Includer(std::filesystem::path root) : mRoot(std::move(root)) {}

    // Returns null if there is none; the compiler reports that with file and line.
    IncludeResult* includeLocal(const char* name, const char* from, size_t depth) override {
        if (depth > kMostNested) return nullptr;
        for (const auto& path : {std::filesystem::path(from).parent_path() / name, mRoot / name}) {
            std::error_code failure;
            if (!std::filesystem::is_regular_file(path, failure)) continue;
            try { // exceptions must not pass through the compiler
                auto text = std::make_unique<std::string>(readText(path));
                auto* result = new IncludeResult(path.string(), text->data(), text->size(), text.get());
                text.release();
                return result;
            } catch (const Error&) {
                return nullptr;
            }
        }
        return nullptr;
    }

    void releaseInclude(IncludeResult* result) override {
        if (!result) return;
        delete static_cast<std::string*>(result->userData);
        delete result;
    }

  private:
    std::filesystem::path mRoot;
};

struct Glslang {
    Glslang() { glslang::InitializeProcess(); }
    ~Glslang() { glslang::FinalizeProcess(); }
};

EShLanguage stageOf(const std::filesystem::path& source) {
    const std::string extension = source.extension();
    if (extension == ".comp") return EShLangCompute;
    if (extension == ".vert") return EShLangVertex;
    if (extension == ".frag") return EShLangFragment;
    throw Error(fmt::format("{}: expected a shader that ends in .comp, .vert or .frag", source.string()));
}

// Returns the errors in the compiler's log, one per line: "FILE:LINE: …".
std::string errorsIn(const std::string& log) {
    constexpr std::string_view kPrefix = "ERROR: ";
    std::istringstream lines(log);
    std::string errors;
    for (std::string line; std::getline(lines, line);) {
        if (!line.starts_with(kPrefix) || line.find("compilation errors.") != std::string::npos ||
            line.find("compilation terminated") != std::string::npos)
            continue;
        if (!errors.empty()) errors += '\n';
        errors += line.substr(kPrefix.size(), line.find_last_not_of(' ') + 1 - kPrefix.size());
    }
    return errors.empty() ? log : errors;
}

} // namespace

std::vector<uint32_t> compileShader(const std::filesystem::path& source,
                                    std::span<const std::string_view> macros) {
    static const Glslang process;
    const EShLanguage stage = stageOf(source);
    const std::string text = readText(source), name = source.string();
    const char* const texts[] = {text.data()};
    const int lengths[] = {int(text.size())};
    const char* const names[] = {name.c_str()};

    // Options as in shaders/CMakeLists.txt: glslangValidator -V -Os --target-env vulkan1.3 -I…
    glslang::TShader shader(stage);
    shader.setStringsWithLengthsAndNames(texts, lengths, names, 1);
    std::string preamble;
    for (const std::string_view macro : macros)
        if (!macro.empty()) preamble += fmt::format("#define {}\n", macro);
    shader.setPreamble(preamble.c_str());
    shader.setEnvInput(glslang::EShSourceGlsl, stage, glslang::EShClientVulkan, 100);
    shader.setEnvClient(glslang::EShClientVulkan, glslang::EShTargetVulkan_1_3);
    shader.setEnvTarget(glslang::EShTargetSpv, glslang::EShTargetSpv_1_6);
    constexpr auto kMessages = EShMessages(EShMsgSpvRules | EShMsgVulkanRules);
    Includer includer(std::filesystem::absolute(source).lexically_normal().parent_path().parent_path());
    if (!shader.parse(GetDefaultResources(), 100, false, kMessages, includer))
        throw Error(errorsIn(shader.getInfoLog()));
    glslang::TProgram program;
    program.addShader(&shader);
    if (!program.link(kMessages)) throw Error(fmt::format("{}: {}", name, errorsIn(program.getInfoLog())));
    glslang::SpvOptions options;
    options.disableOptimizer = false;
    options.optimizeSize = true;
    std::vector<uint32_t> spirv;
    glslang::GlslangToSpv(*program.getIntermediate(stage), spirv, &options);
    return spirv;
}

#else

std::vector<uint32_t> compileShader(const std::filesystem::path& source, std::span<const std::string_view>) {
    throw Error(
        fmt::format("{}: cannot be compiled: this program was built without glslang (on Debian: glslang-dev)",
                    source.string()));
}

#endif

size_t reloadShaders(vk::Device& device, const std::filesystem::path& folder) {
    std::error_code failure;
    if (!std::filesystem::is_directory(folder, failure))
        throw Error(fmt::format("{}: the shaders' sources are not there; RELUME_SHADERS names their folder",
                                folder.string()));
    std::vector<vk::ShaderReplacement> replacements;
    for (const FrameShader& shader : kFrameShaders) {
        const std::filesystem::path source = folder / shader.file;
        const std::string_view macros[] = {shader.macro,
                                           device.info().takesPortableShaders() ? "PORTABLE" : ""};
        replacements.push_back({source.string(), shader.spirv, compileShader(source, macros)});
    }
    return device.replaceShaders(replacements);
}

} // namespace relume

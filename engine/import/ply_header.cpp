#include "engine/import/ply_header.h"

#include "engine/base/error.h"

#include <algorithm>
#include <charconv>
#include <fmt/core.h>

namespace relume {
namespace {

constexpr PlyScalarType kTypes[] = {{"char", "int8", 1, 'i'},     {"uchar", "uint8", 1, 'u'},
                                    {"short", "int16", 2, 'i'},   {"ushort", "uint16", 2, 'u'},
                                    {"int", "int32", 4, 'i'},     {"uint", "uint32", 4, 'u'},
                                    {"float", "float32", 4, 'f'}, {"double", "float64", 8, 'f'}};

std::vector<std::string_view> splitWords(std::string_view line) {
    std::vector<std::string_view> words;
    for (size_t start = 0; start < line.size();) {
        const size_t end = std::min(line.find_first_of(" \t\r", start), line.size());
        if (end > start) words.push_back(line.substr(start, end - start));
        start = end + 1;
    }
    return words;
}

constexpr size_t kMostLines = 1000;

class HeaderReader {
  public:
    HeaderReader(std::string_view text, const std::string& name) : mText(text), mName(name) {}

    PlyHeader read() {
        if (splitWords(takeLine()) != std::vector<std::string_view>{"ply"})
            throw Error(fmt::format("{}: expected a PLY file, whose first line is \"ply\"", mName));
        for (bool isOpen = true; isOpen;) {
            const std::string_view line = takeLine();
            const std::vector<std::string_view> words = splitWords(line);
            const std::string_view keyword = words.empty() ? "" : words[0];
            if (keyword == "format" && words.size() == 3)
                readFormat(words[1], words[2]);
            else if (keyword == "element" && words.size() == 3)
                readElement(words[1], words[2], line);
            else if (keyword == "property" && !mHeader.elements.empty())
                readProperty(words, line);
            else if (keyword == "end_header")
                isOpen = false;
            else if (keyword != "comment" && keyword != "obj_info" && keyword != "")
                fail(line);
        }
        if (!mHasFormat)
            throw Error(
                fmt::format("{}: the PLY header has no format: expected a line \"format ascii 1.0\" or "
                            "the like: export the mesh again",
                            mName));
        mHeader.size = mStart;
        return std::move(mHeader);
    }

  private:
    [[noreturn]] void fail(std::string_view line) const {
        throw Error(
            fmt::format("{}: header line {} is not understood: \"{}\"", mName, mLine, line.substr(0, 80)));
    }

    std::string_view takeLine() {
        const size_t end = mText.find('\n', mStart);
        if (end == std::string_view::npos)
            throw Error(fmt::format("{}: the PLY header has no end: expected a line \"end_header\"", mName));
        if (++mLine > kMostLines)
            throw Error(
                fmt::format("{}: the PLY header has more than {} lines: leave out comments, and elements "
                            "other than vertices and faces",
                            mName, kMostLines));
        const std::string_view line = mText.substr(mStart, end - mStart);
        mStart = end + 1;
        return line;
    }

    void readFormat(std::string_view format, std::string_view version) {
        if (version != "1.0")
            throw Error(fmt::format("{}: is PLY of version {}: expected 1.0: export the mesh again", mName,
                                    version.substr(0, 40)));
        mHasFormat = true;
        if (format == "ascii")
            mHeader.encoding = PlyEncoding::Ascii;
        else if (format == "binary_little_endian")
            mHeader.encoding = PlyEncoding::LittleEndian;
        else if (format == "binary_big_endian")
            mHeader.encoding = PlyEncoding::BigEndian;
        else
            fail(format);
    }

    void readElement(std::string_view element, std::string_view count, std::string_view line) {
        uint64_t value = 0;
        const auto [end, failure] = std::from_chars(count.data(), count.data() + count.size(), value);
        if (failure != std::errc() || end != count.data() + count.size()) fail(line);
        mHeader.elements.push_back({std::string(element), value, {}});
    }

    void readProperty(const std::vector<std::string_view>& words, std::string_view line) {
        const bool isList = words.size() == 5 && words[1] == "list";
        if (!isList && words.size() != 3) fail(line);
        const PlyProperty property{std::string(words.back()), findType(words[words.size() - 2], line),
                                   isList ? findType(words[2], line) : nullptr};
        if (isList && property.countType->kind == 'f') fail(line);
        mHeader.elements.back().properties.push_back(property);
    }

    const PlyScalarType* findType(std::string_view word, std::string_view line) const {
        for (const PlyScalarType& type : kTypes)
            if (word == type.name || word == type.otherName) return &type;
        fail(line);
    }

    std::string_view mText;
    const std::string& mName;
    PlyHeader mHeader;
    size_t mStart = 0, mLine = 0;
    bool mHasFormat = false;
};

} // namespace

PlyHeader readPlyHeader(std::string_view file, const std::string& name) {
    return HeaderReader(file, name).read();
}

} // namespace relume

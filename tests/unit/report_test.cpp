// Reports: nothing in a text becomes markup, tables are read back as they were, pictures are in the page.
#include "apps/evaluation/base64.h"
#include "apps/evaluation/report_html.h"
#include "engine/base/error.h"
#include "engine/import/image_file.h"
#include "tests/support/temporary_folder.h"

#include <cstring>
#include <doctest/doctest.h>

using namespace relume;
using namespace relume::test;

namespace {

bool says(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

std::string encoded(const std::string& text) { return base64(std::as_bytes(std::span(text))); }

const std::string kHostile = "<script>alert(\"x\") & 'y'</script>\x01";
const std::string kHarmless = "&lt;script&gt;alert(&quot;x&quot;) &amp; &#39;y&#39;&lt;/script&gt; ";

} // namespace

TEST_CASE("base64: the examples of RFC 4648") {
    CHECK_EQ(encoded(""), "");
    CHECK_EQ(encoded("f"), "Zg==");
    CHECK_EQ(encoded("fo"), "Zm8=");
    CHECK_EQ(encoded("foo"), "Zm9v");
    CHECK_EQ(encoded("foob"), "Zm9vYg==");
    CHECK_EQ(encoded("fooba"), "Zm9vYmE=");
    CHECK_EQ(encoded("foobar"), "Zm9vYmFy");
    CHECK_EQ(encoded("\xff\xef\xbe"), "/+++");
}

TEST_CASE("report: cells with commas, quotes and line breaks are quoted in CSV") {
    const ReportTable table{"t", "", {"a", "b,c"}, {{"plain", "say \"so\""}, {"two\nlines", ""}}, ""};
    CHECK_EQ(csvOf(table), "a,\"b,c\"\r\nplain,\"say \"\"so\"\"\"\r\n\"two\nlines\",\r\n");
}

TEST_CASE("report: all text is escaped") {
    const TemporaryFolder folder;
    writePng(folder.path() / "a.png", Image(2, 2));
    Report report{kHostile, {{kHostile, kHostile}}, {kHostile}, {}};
    ReportSection section{kHostile, {}};
    section.say(kHostile);
    section.add(ReportTable{"t", kHostile, {kHostile}, {{kHostile}}, kHostile});
    section.add(ReportFigure{kHostile, 1, {{"a.png", kHostile, kHostile}}, kHostile});
    section.add(ReportPlot{"p", kHostile, "<svg/>"});
    report.sections.push_back(section);
    report.findings = {kHostile};
    const std::string html = htmlOf(report, folder.path());
    CHECK_FALSE(says(html, "<script"));
    CHECK_FALSE(says(html, "\x01"));
    size_t count = 0;
    for (size_t at = html.find(kHarmless); at != std::string::npos; at = html.find(kHarmless, at + 1))
        count++;
    CHECK_EQ(count, 20u);
}

TEST_CASE("report: what was found comes before all else") {
    Report report{"title", {{"Device", "d"}}, {"missing"}, {{"first"}}, {"found a", "found b"}};
    const std::string html = htmlOf(report, "");
    const size_t a = html.find("found a"), b = html.find("found b");
    REQUIRE_NE(b, std::string::npos);
    CHECK_LT(a, b);
    for (const char* later : {"Device", "missing", "<h2>first"}) CHECK_LT(b, html.find(later));
    report.findings.clear();
    CHECK_FALSE(says(htmlOf(report, ""), "What was found"));
}

TEST_CASE("report: pictures are in the page, which asks for nothing else") {
    const TemporaryFolder folder;
    writePng(folder.path() / "a.png", Image(2, 2));
    Report report{"title", {}, {}, {{"section", {}}}};
    report.sections[0].add(ReportFigure{"figure", 1, {{"a.png", "", ""}}, ""});
    report.sections[0].add(ReportPlot{"p", "plot", "<svg/>"});
    const std::string html = htmlOf(report, folder.path());
    CHECK(says(html, "src=\"data:image/png;base64," + base64(readFile(folder.path() / "a.png")) + "\""));
    CHECK(says(html, "src=\"data:image/svg+xml;base64," + encoded("<svg/>") + "\""));
    for (const char* part : {"http", "src=\"a.png", "<link", "url("}) CHECK_FALSE(says(html, part));
    report.sections[0].add(ReportFigure{"figure", 1, {{"gone.png", "", ""}}, ""});
    CHECK_THROWS_AS(htmlOf(report, folder.path()), Error);
}

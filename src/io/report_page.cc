#include "report_page.h"

#include "report_text.h"

namespace stereomotion {
namespace {

// Light and sober, readable in print and on a narrow screen.
constexpr const char* kStyle = R"(
body { font: 15px/1.45 system-ui, "Helvetica Neue", Arial, sans-serif; color: #222; background: #fff;
  max-width: 1180px; margin: 0 auto; padding: 16px 20px; }
h1 { font-size: 24px; font-weight: 600; margin: 4px 0; }
h2 { font-size: 19px; font-weight: 600; border-bottom: 1px solid #ccc; margin: 34px 0 10px; }
h3 { font-size: 16px; font-weight: 600; margin: 18px 0 4px; }
p, ul, ol, dl { margin: 6px 0; max-width: 900px; }
.small, figcaption, .meta { font-size: 13px; color: #555; }
.verdict { border-left: 6px solid #2c7a5b; background: #f3f7f5; padding: 8px 16px; margin: 14px 0; }
.verdict.usable_with_warnings { border-color: #c98a00; background: #fbf7ec; }
.verdict.doubtful { border-color: #b3261e; background: #fbf0ef; }
.level { font-size: 19px; font-weight: 600; }
dt { margin-top: 8px; } dd { margin: 0 0 0 20px; }
code { font: 13px ui-monospace, "DejaVu Sans Mono", Consolas, monospace; overflow-wrap: anywhere; }
.wide { overflow-x: auto; }
table { border-collapse: collapse; font-size: 13px; font-variant-numeric: tabular-nums; }
th, td { padding: 2px 10px; border-bottom: 1px solid #e4e4e4; vertical-align: top; }
th { font-weight: 600; border-bottom: 1px solid #888; vertical-align: bottom; }
.l { text-align: left; } .r { text-align: right; }
tr.bad td { background: #fbe9e7; }
.figures { display: grid; grid-template-columns: repeat(auto-fit, minmax(min(100%, 480px), 1fr));
  gap: 12px 24px; }
.slices { display: flex; flex-wrap: wrap; gap: 6px; }
figure { margin: 6px 0; break-inside: avoid; } figcaption { max-width: 560px; }
.slice { width: 338px; } .bar { width: 94px; }
svg { width: 100%; height: auto; display: block; fill: #333; }
svg text { font: 12px system-ui, "Helvetica Neue", Arial, sans-serif; }
svg text.cell { font-size: 10px; }
svg text.bad { fill: #b3261e; font-size: 11px; paint-order: stroke; stroke: #fff;
  stroke-width: 3px; }
sub, sup { line-height: 0; }
.frame { fill: none; stroke: #888; } .axis { stroke: #888; fill: none; }
.vector { stroke: #2a5d8f; stroke-width: 1; fill: none; opacity: .65; }
.dot { stroke: #2a5d8f; stroke-width: 2.4; stroke-linecap: round; }
.outlier { stroke: #c62828; stroke-width: 1.4; fill: none; }
.scale { stroke: #222; stroke-width: 1.4; fill: none; }
.cloud { stroke: #777; stroke-width: 2.6; stroke-linecap: round; opacity: .6; }
.band { fill: #f0f0f0; } .ring { stroke: #1f5fa8; stroke-width: 2.2; fill: none; }
.across { stroke: #d07000; } .radial { color: #1f5fa8; } .tangential { color: #b86200; }
.unseen { fill: url(#hatch); }
.left { color: #1f5fa8; } .right { color: #b86200; }
.line { stroke-width: 1.6; fill: none; } .x { stroke: #1f5fa8; } .y { stroke: #c46a00; }
.z { stroke: #2c7a5b; } .sigma { opacity: .22; stroke: none; } .sigma.x { fill: #1f5fa8; }
.sigma.y { fill: #c46a00; } .sigma.z { fill: #2c7a5b; }
b.x { color: #1f5fa8; } b.y { color: #b86200; } b.z { color: #2c7a5b; }
.seen { stroke: #2a5d8f; stroke-width: 3; stroke-linecap: round; fill: none; opacity: .55; }
.rough { stroke: #c62828; stroke-width: 3; stroke-linecap: round; fill: none; opacity: .7; }
.mask { fill: url(#hatch); stroke: #555; stroke-width: 1; }
.lost { stroke: #c62828; stroke-width: 1; fill: none; opacity: .7; }
.ball { fill: none; stroke: #999; stroke-width: 1.4; } .ball.end { fill: #222; stroke: none; }
@media print { body { font-size: 11px; max-width: none; padding: 0; } .wide { overflow: visible; }
  * { print-color-adjust: exact; -webkit-print-color-adjust: exact; } }
)";

// Defined once for all figures of the page.
constexpr const char* kHatch =
    "<svg xmlns=\"http://www.w3.org/2000/svg\" style=\"position:absolute;width:0;height:0\">"
    "<defs><pattern id=\"hatch\" width=\"6\" height=\"6\" patternUnits=\"userSpaceOnUse\">"
    "<path d=\"M0 6L6 0\" stroke=\"#bbb\"/></pattern></defs></svg>\n";

}  // namespace

std::string PageHead(std::string_view title, std::string_view heading, std::string_view meta) {
  return "<!DOCTYPE html>\n<html xmlns=\"http://www.w3.org/1999/xhtml\" lang=\"en\">"
         "<head><meta charset=\"utf-8\"/>\n"
         "<meta name=\"viewport\" content=\"width=device-width\"/>\n<title>" +
         EscapeHtml(title) + "</title>\n<style>" + kStyle + "</style></head><body>\n" + kHatch +
         "<h1>" + EscapeHtml(heading) + "</h1>\n<p class=\"meta\">" + EscapeHtml(meta) + "</p>\n";
}

std::string PageEnd() { return "</body></html>\n"; }

}  // namespace stereomotion

#include "report/page_assets.h"

namespace tessera::report
{

const std::string_view kPageStyle = R"css(
:root{--ground:#f6f6f4;--card:#fff;--text:#1b1e22;--quiet:#5a6068;--line:#dfe1e4;--accent:#1f66d1;--good:#e9f3ea;color-scheme:light dark}
@media (prefers-color-scheme:dark){:root{--ground:#111317;--card:#191c21;--text:#e6e9ed;--quiet:#a0a7b0;--line:#30353c;--accent:#6ea8fe;--good:#1d2b20}}
*{box-sizing:border-box}
[hidden]{display:none!important}
body{margin:0;background:var(--ground);color:var(--text);font:15px/1.5 system-ui,"DejaVu Sans",sans-serif}
main{max-width:1500px;margin:0 auto;padding:24px 20px 60px}
h1{font-size:26px;margin:0 0 2px}
h2{font-size:19px;margin:38px 0 10px}
p,li{max-width:92ch}
.quiet,figcaption{color:var(--quiet)}
.advice{background:var(--card);border:1px solid var(--line);border-left:4px solid var(--accent);border-radius:6px;padding:12px 16px;margin:16px 0}
.advice p{margin:4px 0}
.grid2{display:grid;grid-template-columns:repeat(auto-fit,minmax(min(100%,560px),1fr));gap:16px}
.plot{width:100%;height:auto;display:block;border:1px solid var(--line);border-radius:6px}
.passes{margin-top:16px}.passes .plot{max-width:920px}
.choice{display:flex;flex-wrap:wrap;gap:6px 16px;align-items:center;margin:10px 0}
select{font:inherit;color:inherit;background:var(--card);border:1px solid var(--line);border-radius:5px;padding:3px 6px}
.scroll{overflow-x:auto;border:1px solid var(--line);border-radius:6px;background:var(--card)}
table{border-collapse:collapse;font-size:13px;font-variant-numeric:tabular-nums;width:100%}
th,td{padding:5px 9px;text-align:right;white-space:nowrap;border-bottom:1px solid var(--line)}
th{font-weight:600;color:var(--quiet);position:sticky;top:0;background:var(--card)}
td.text,th.text{text-align:left}
td.wide{white-space:normal;min-width:36ch}
tr.front td{background:var(--good)}
tbody tr:last-child td{border-bottom:0}
.compare{position:relative;background:#000;border-radius:6px;overflow:hidden;line-height:0;user-select:none}
.compare img{width:100%;display:block}
.compare img.above{position:absolute;inset:0;height:100%;clip-path:inset(0 0 0 var(--cut,50%))}
.compare .knife{position:absolute;top:0;bottom:0;left:var(--cut,50%);width:2px;background:#fff;box-shadow:0 0 3px #000}
.compare input{position:absolute;inset:0;width:100%;height:100%;margin:0;opacity:0;cursor:ew-resize}
.compare input:focus-visible{opacity:.25}
.heat{background:#4a4f57;border-radius:6px;width:100%;display:block;image-rendering:pixelated}
.scale{height:12px;border-radius:3px;margin-top:8px}
.ends{display:flex;justify-content:space-between;font-size:12px;color:var(--quiet)}
figure{margin:0}
code,pre{font-family:ui-monospace,"DejaVu Sans Mono",monospace;font-size:13px}
pre{background:var(--card);border:1px solid var(--line);border-radius:6px;padding:10px 12px;overflow-x:auto}
dl{display:grid;grid-template-columns:max-content 1fr;gap:3px 18px;margin:0}
dt{color:var(--quiet)}dd{margin:0}
@media print{.choice{display:none}.scroll{overflow:visible}}
)css";

const std::string_view kPageScript = R"js(
"use strict";
const byId = id => document.getElementById(id);
const kind = byId("kind");
const showKind = () => document.querySelectorAll("[data-kind]").forEach(e => { e.hidden = e.dataset.kind !== kind.value; });
kind.addEventListener("change", showKind);
showKind();

const pictures = JSON.parse(byId("pictures").textContent);
if (pictures.length > 0)
{
	const left = byId("left"), right = byId("right"), compare = byId("compare");
	for (const select of [left, right])
		pictures.forEach((p, i) => select.add(new Option(p.name, i)));
	const show = () => {
		const below = pictures[left.value], above = pictures[right.value];
		byId("below").src = below.src;
		byId("below").alt = below.name;
		byId("above").src = above.src;
		byId("above").alt = above.name;
		const heat = byId("heat");
		heat.hidden = !below.heat;
		if (below.heat)
			heat.src = below.heat;
		heat.alt = "error of " + below.name;
		byId("heat_of").textContent = below.heat ? below.name : below.name + ": it is what the others are compared with";
	};
	right.value = pictures.length - 1;
	for (const select of [left, right])
		select.addEventListener("change", show);
	byId("knife").addEventListener("input", e => compare.style.setProperty("--cut", e.target.value + "%"));
	show();
}
)js";

}  // namespace tessera::report

#include "report/page_pictures.h"

#include "base/file.h"
#include "output/png.h"
#include "report/heat.h"
#include "scene/image_decode.h"
#include "scene/metric.h"

#include <algorithm>
#include <cmath>
#include <set>

namespace tessera::report
{

namespace
{

constexpr uint32_t kMostWidth = 800;

std::string base64(std::span<const std::byte> bytes)
{
	constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
	std::string text;
	text.reserve((bytes.size() + 2) / 3 * 4);
	for (size_t i = 0; i < bytes.size(); i += 3)
	{
		uint32_t word = 0;
		for (size_t k = 0; k < 3; ++k)
			word = word << 8 | (i + k < bytes.size() ? std::to_integer<uint32_t>(bytes[i + k]) : 0);
		for (size_t k = 0; k < 4; ++k)
			text += i + k > bytes.size() ? '=' : kDigits[word >> (18 - 6 * k) & 63];
	}
	return text;
}

// RGB, averaged over whole blocks of pixels until it is narrow enough; sRGB values are averaged as they are.
Result<std::vector<std::byte>> smallPng(const Image& image)
{
	const uint32_t block = (image.width + kMostWidth - 1) / kMostWidth;
	const uint32_t width = image.width / block, height = std::max(image.height / block, 1u);
	std::vector<std::byte> rgb;
	rgb.reserve(size_t(width) * height * 3);
	for (uint32_t y = 0; y < height; ++y)
		for (uint32_t x = 0; x < width; ++x)
			for (uint32_t channel = 0; channel < 3; ++channel)
			{
				uint32_t sum = 0, count = 0;
				for (uint32_t v = y * block; v < std::min((y + 1) * block, image.height); ++v)
					for (uint32_t u = x * block; u < (x + 1) * block; ++u, ++count)
						sum += std::to_integer<uint32_t>(image.texels[(size_t(v) * image.width + u) * image.channels + channel]);
				rgb.push_back(std::byte((sum + count / 2) / count));
			}
	return encodePng({ width, height, 3, 8, rgb });
}

Result<std::string> pictureUri(const std::filesystem::path& path)
{
	std::vector<std::string> warnings;
	TRY_ASSIGN(const Image image, readImage(path, warnings));
	if (image.channels < 3 || image.format != TexelFormat::U8)
		return badInput("{}: not a picture of a report", path.string());
	TRY_ASSIGN(const std::vector<std::byte> png, smallPng(image));
	return "data:image/png;base64," + base64(png);
}

Result<std::string> fileUri(const std::filesystem::path& path)
{
	TRY_ASSIGN(const std::vector<std::byte> bytes, readFile(path));
	return "data:image/png;base64," + base64(bytes);
}

}  // namespace

Result<std::string> picturesJson(const std::filesystem::path& folder, const ReportData& data)
{
	nlohmann::json json = nlohmann::json::array();
	const bool many_sizes = bySize(data.runs).size() > 1;
	const bool many_metrics =
		std::any_of(data.runs.begin(), data.runs.end(), [&](const Run& run) { return run.setting.metric != data.runs[0].setting.metric; });
	const auto nameFor = [&](double rate, const Setting& setting) {
		return fmt::format("rate {:g}{}{}", rate, many_metrics ? ", " + setting.metric : "",
						   many_sizes ? fmt::format(", {}x{}", setting.width, setting.height) : "");
	};
	std::set<std::string> there;
	for (const Run& run : data.runs)
	{
		const std::string name = nameFor(run.setting.rate, run.setting);
		if (run.picture.empty() || !there.insert(name).second)
			continue;
		TRY_ASSIGN(const std::string src, pictureUri(folder / run.picture));
		json.push_back({ { "name", name }, { "src", src } });
		if (!run.heat.empty())
		{
			TRY_ASSIGN(const std::string heat, fileUri(folder / run.heat));
			json.back()["heat"] = heat;
		}
	}
	for (const Run& run : data.runs)
	{
		// Always drawn by the metric edge.
		Setting setting = run.setting;
		setting.metric = metricName(Metric::Edge);
		const std::string name = nameFor(run.reference.rate_granted, setting) + " (reference)";
		if (!run.image || !there.insert(name).second)
			continue;
		TRY_ASSIGN(const std::string src, pictureUri(folder / run.reference.picture));
		json.push_back({ { "name", name }, { "src", src } });
	}
	return json.dump();
}

std::string picturesHtml()
{
	std::string stops;
	for (int i = 0; i <= 20; ++i)
	{
		const auto color = heatColor(kHeatLeastPx * std::pow(kHeatMostPx / kHeatLeastPx, i / 20.0));
		stops += fmt::format("{}rgb({},{},{})", i ? "," : "", color[0], color[1], color[2]);
	}
	return fmt::format(
		"<h2>Pictures</h2><div class=\"choice\"><label>Left: <select id=\"left\"></select></label><label>Right: <select "
		"id=\"right\"></select></label>"
		"<span class=\"quiet\">drag over the picture</span></div><div class=\"grid2\"><figure><div class=\"compare\" id=\"compare\"><img "
		"id=\"below\" "
		"alt=\"\"><img id=\"above\" class=\"above\" alt=\"\"><div class=\"knife\"></div><input id=\"knife\" type=\"range\" min=\"0\" max=\"100\" "
		"step=\"0.2\" value=\"50\" aria-label=\"where the left picture ends\"></div><figcaption>Full size: folder <code>pictures</code>."
		"</figcaption></figure><figure><img id=\"heat\" class=\"heat\" alt=\"\"><div class=\"scale\" style=\"background:linear-gradient(to "
		"right,{})\">"
		"</div><div class=\"ends\"><span>1/64 px or less</span><span>1/2 px</span><span>16 px or more</span></div><figcaption>Distance of the "
		"surfaces "
		"in pixels, of the left picture: <span id=\"heat_of\"></span></figcaption></figure></div>",
		stops);
}

}  // namespace tessera::report

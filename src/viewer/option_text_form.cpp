#include "viewer/option_text_form.h"

#include "app/camera_path.h"

#include <algorithm>

namespace tessera::view
{

namespace
{

// Say how the program runs, not what it draws.
constexpr std::string_view kNotOfThePicture[] = { "frames", "warmup", "rates",     "rasters",  "metrics", "sizes", "reference-rate",   "max-error-px",
												  "max-ms", "resume", "pipelines", "validate", "strict",  "quiet", "measure-left-out", "original" };

std::string quoted(const std::string& text)
{
	constexpr std::string_view kPlain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-+./:,=@%";
	if (!text.empty() && text.find_first_not_of(kPlain) == std::string::npos)
		return text;
	std::string result = "'";
	for (char c : text)
		result += c == '\'' ? std::string("'\\''") : std::string(1, c);
	return result + "'";
}

}  // namespace

Result<AppOptions> withOption(const OptionDesc& option, const std::vector<std::string>& values, const AppOptions& options)
{
	AppOptions changed;
	for (const OptionDesc& other : optionTable())
		if (other.name != option.name)
			for (const std::string& value : printOption(other, options))
				TRY(setOption(other, value, changed));
	for (const std::string& value : values)
		TRY(setOption(option, value, changed));
	return changed;
}

AppOptions withCamera(const AppOptions& options, const Camera& camera)
{
	AppOptions changed = options;
	changed.camera.reset();
	changed.camera_path.clear();
	changed.eye = camera.eye;
	changed.target = camera.target;
	changed.up = camera.up;
	changed.near_world = camera.near_world > 0 ? std::optional(camera.near_world) : std::nullopt;
	changed.fov_deg = camera.orthographic ? std::nullopt : std::optional(degreesOf(camera.fov_y_rad));
	changed.ortho_world = camera.orthographic ? std::optional(camera.height_world) : std::nullopt;
	return changed;
}

std::string renderCommandLine(const std::string& scene, const AppOptions& options, const Camera& camera)
{
	const AppOptions shown = withCamera(options, camera);
	std::string text = "tessera render " + quoted(scene);
	for (const OptionDesc& option : optionTable())
	{
		const std::vector<std::string> values = printOption(option, shown);
		if (std::ranges::find(kNotOfThePicture, option.name) != std::end(kNotOfThePicture) || values == printOption(option, {}))
			continue;
		for (const std::string& value : values)
			text += fmt::format(" --{}{}{}", option.name, value.empty() ? "" : "=", value.empty() ? "" : quoted(value));
	}
	return text;
}

}  // namespace tessera::view

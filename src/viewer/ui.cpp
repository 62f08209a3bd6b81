#include "viewer/ui.h"

#include "viewer/option_text_form.h"

#include <imgui_stdlib.h>

#include <algorithm>
#include <cmath>

namespace tessera::view
{

namespace
{

const ImVec4 kErrorColor = { 1.0f, 0.45f, 0.35f, 1.0f };
constexpr float kTooltipWidth = 28;  // letters

std::string idOf(const std::string& name, const std::string& label)
{
	return label + "##" + name;
}

std::string joined(const std::vector<std::string>& values)
{
	std::string text;
	for (const std::string& value : values)
		text += (text.empty() ? "" : " ") + value;
	return text;
}

std::vector<std::string> words(const std::string& text)
{
	std::vector<std::string> values;
	for (size_t at = 0; at < text.size();)
	{
		const size_t first = text.find_first_not_of(' ', at);
		if (first == std::string::npos)
			break;
		at = std::min(text.find(' ', first), text.size());
		values.push_back(text.substr(first, at - first));
	}
	return values;
}

}  // namespace

std::string optionTooltip(const OptionDesc& option)
{
	std::string text = fmt::format("{}\n--{}{}{}", option.help, option.name, option.value.empty() ? "" : " ", option.value);
	if (option.most > option.least && option.most < 1e9)
		text += fmt::format(", from {} to {}", option.least, option.most);
	return text;
}

void Ui::note(const std::string& name, const std::string& tooltip)
{
	places_[name] = { ImGui::GetItemRectMin(), ImGui::GetItemRectMax(), ImGui::IsItemVisible() };
	if (tooltip.empty() || !ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled))
		return;
	ImGui::BeginTooltip();
	ImGui::PushTextWrapPos(ImGui::GetFontSize() * kTooltipWidth);
	ImGui::TextUnformatted(tooltip.c_str());
	ImGui::PopTextWrapPos();
	ImGui::EndTooltip();
}

bool Ui::button(const std::string& name, const std::string& label, const std::string& tooltip)
{
	const bool pressed = ImGui::Button(idOf(name, label).c_str());
	note(name, tooltip);
	return pressed;
}

bool Ui::checkbox(const std::string& name, const std::string& label, bool& value, const std::string& tooltip)
{
	const bool changed = ImGui::Checkbox(idOf(name, label).c_str(), &value);
	note(name, tooltip);
	return changed;
}

bool Ui::combo(const std::string& name, const std::string& label, std::span<const std::string_view> names, size_t& index, const std::string& tooltip)
{
	const std::string shown(names[index]);
	const bool open = ImGui::BeginCombo(idOf(name, label).c_str(), shown.c_str(), ImGuiComboFlags_HeightLargest);
	note(name, open ? "" : tooltip);
	if (!open)
		return false;
	bool changed = false;
	for (size_t i = 0; i < names.size(); ++i)
	{
		const std::string choice(names[i]);
		if (ImGui::Selectable(choice.c_str(), i == index))
		{
			changed = i != index;
			index = i;
		}
		note(name + "." + choice, "");
	}
	ImGui::EndCombo();
	return changed;
}

bool Ui::number(const std::string& name, const std::string& label, double& value, const std::string& tooltip, const char* format)
{
	double edited = value;
	ImGui::InputDouble(idOf(name, label).c_str(), &edited, 0, 0, format);
	const bool done = ImGui::IsItemDeactivatedAfterEdit();
	note(name, tooltip);
	if (!done || !std::isfinite(edited) || edited == value)
		return false;
	value = edited;
	return true;
}

bool Ui::slider(const std::string& name, const std::string& label, float& value, float least, float most, const std::string& tooltip)
{
	const bool decades = least > 0 && most / least > 50;
	const bool changed = ImGui::SliderFloat(idOf(name, label).c_str(), &value, least, most, "%.4g", decades ? ImGuiSliderFlags_Logarithmic : 0);
	note(name, tooltip);
	return changed;
}

bool Ui::text(const std::string& name, const std::string& label, std::string& value, const std::string& tooltip)
{
	const bool entered = ImGui::InputText(idOf(name, label).c_str(), &value, ImGuiInputTextFlags_EnterReturnsTrue);
	note(name, tooltip);
	return entered;
}

// What is typed counts when Enter is pressed; until it is right, what is wrong stands below.
bool Ui::textOption(const OptionDesc& option, AppOptions& options, const std::string& tooltip)
{
	const std::string name(option.name);
	TextField& field = fields_[name];
	if (!field.is_edited)
		field.text = joined(printOption(option, options));
	const bool entered = text(name, name, field.text, tooltip + "\nEnter applies it; empty: the default");
	field.is_edited = ImGui::IsItemActive() || (!field.error.empty() && !entered);
	bool changed = false;
	if (entered)
	{
		Result<AppOptions> result = withOption(option,
											   option.repeatable    ? words(field.text)
											   : field.text.empty() ? std::vector<std::string>()
																	: std::vector{ field.text },
											   options);
		field.error = result ? "" : result.error().message;
		field.is_edited = !result;
		if (result)
			options = std::move(*result);
		changed = result.has_value();
	}
	if (!field.error.empty())
	{
		ImGui::PushStyleColor(ImGuiCol_Text, kErrorColor);
		ImGui::TextWrapped("%s", field.error.c_str());
		ImGui::PopStyleColor();
	}
	return changed;
}

bool Ui::cullOption(const OptionDesc&, AppOptions& options, const std::string& tooltip)
{
	bool changed = checkbox("cull.frustum", "cull beyond the frustum", options.cull.frustum, tooltip);
	changed |= checkbox("cull.backface", "cull back faces", options.cull.backface, tooltip);
	changed |= checkbox("cull.occlusion", "cull what is hidden", options.cull.occlusion, tooltip);
	return changed;
}

bool Ui::option(std::string_view option_name, AppOptions& options)
{
	const OptionDesc& option = *findOption(option_name);
	const std::string name(option.name), tooltip = optionTooltip(option);
	if (name == "cull")
		return cullOption(option, options, tooltip);
	if (const auto* flag = std::get_if<bool AppOptions::*>(&option.field))
		return checkbox(name, name, options.**flag, tooltip);
	if (const auto* choice = std::get_if<Choice>(&option.field))
	{
		size_t index = choice->get(options);
		if (!combo(name, name, choice->names, index, tooltip))
			return false;
		choice->set(options, index);
		return true;
	}
	if (const auto* count = std::get_if<uint32_t AppOptions::*>(&option.field))
	{
		int value = static_cast<int>(options.**count);
		const bool changed = ImGui::SliderInt(idOf(name, name).c_str(), &value, static_cast<int>(option.least), static_cast<int>(option.most), "%d",
											  ImGuiSliderFlags_AlwaysClamp);
		note(name, tooltip);
		options.** count = static_cast<uint32_t>(value);
		return changed;
	}
	return textOption(option, options, tooltip);
}

}  // namespace tessera::view

// Controls with a name: every one has a tooltip, and where it was drawn is kept, so that a script can find it (--ui-state).
#pragma once
#include "app/options.h"

#include <imgui.h>

#include <map>
#include <string>

namespace tessera::view
{

struct WidgetPlace
{
	ImVec2 low, high;      // pixels of the window
	bool visible = false;  // not scrolled out of sight
};

class Ui
{
public:
	void beginFrame() { places_.clear(); }
	const std::map<std::string, WidgetPlace>& places() const { return places_; }

	bool button(const std::string& name, const std::string& label, const std::string& tooltip);
	bool checkbox(const std::string& name, const std::string& label, bool& value, const std::string& tooltip);
	bool combo(const std::string& name, const std::string& label, std::span<const std::string_view> names, size_t& index, const std::string& tooltip);
	bool number(const std::string& name, const std::string& label, double& value, const std::string& tooltip, const char* format = "%.6g");
	// A slider over the range; logarithmic where that spans decades.
	bool slider(const std::string& name, const std::string& label, float& value, float least, float most, const std::string& tooltip);
	// True when Enter was pressed in it.
	bool text(const std::string& name, const std::string& label, std::string& value, const std::string& tooltip);
	// A row of the option table: control, tooltip and accepted range come from there. True when it was changed.
	bool option(std::string_view name, AppOptions& options);

	// Notes the item drawn last under this name, and shows the tooltip while the mouse rests on it.
	void note(const std::string& name, const std::string& tooltip);

private:
	bool textOption(const OptionDesc& option, AppOptions& options, const std::string& tooltip);
	bool cullOption(const OptionDesc& option, AppOptions& options, const std::string& tooltip);

	struct TextField
	{
		std::string text;
		std::string error;
		bool is_edited = false;
	};
	std::map<std::string, WidgetPlace> places_;
	std::map<std::string, TextField> fields_;
};

// What an option's tooltip says: help, unit and range.
std::string optionTooltip(const OptionDesc& option);

}  // namespace tessera::view

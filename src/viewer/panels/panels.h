// The panels of the side bar, one file each.
#pragma once
#include "viewer/session.h"
#include "viewer/ui.h"

#include <span>

namespace tessera::view
{

struct Panel
{
	std::string_view name;
	std::string_view help;
	void (*draw)(Ui& ui, Session& session);
	std::span<const std::string_view> options;  // rows of the option table that it shows
};

// In the order of the side bar.
std::span<const Panel> panels();

extern const Panel kCameraPanel, kTessellationPanel, kRasterPanel, kViewPanel, kScenePanel, kLimitsPanel, kTimingsPanel, kMemoryPanel, kPlanPanel,
	kGatesPanel, kInspectorPanel, kShadersPanel, kLogPanel;

// Rows of the option table that mean nothing in a window: they belong to single pictures, reports or the start.
std::span<const std::string_view> optionsWithoutPanel();

// Two columns of a table, the value to the right.
void valueRow(const char* name, const std::string& value);
std::string bytesText(uint64_t bytes);

}  // namespace tessera::view

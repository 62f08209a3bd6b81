// The device, what it offers, and what is done instead of what it does not.
#include "viewer/panels/panels.h"

namespace tessera::view
{

namespace
{

constexpr std::string_view kOptions[] = { "device" };

void draw(Ui& ui, Session& session)
{
	const Device& device = *session.device;
	ImGui::TextWrapped("%s", device.name.c_str());
	ImGui::TextWrapped("driver %s, Vulkan %s, subgroups of %u", device.driver.c_str(), device.api.c_str(), device.limits.subgroup_size);
	ui.option("device", session.options);
	for (size_t i = 0; i < session.devices.size(); ++i)
		if (ui.button(fmt::format("device.{}", i), fmt::format("{}: {}", i, session.devices[i]), "draw on this device from now on"))
			session.options.device = std::to_string(i);
	for (const Gate& gate : device.gates.table())
	{
		ImGui::TextColored(gate.open ? ImVec4(0.5f, 0.85f, 0.5f, 1) : ImVec4(0.85f, 0.6f, 0.4f, 1), "%s %s", gate.open ? "open  " : "closed",
						   std::string(gate.name).c_str());
		ui.note("gate." + std::string(gate.name), gate.open ? "" : std::string(gate.instead));
	}
}

}  // namespace

const Panel kGatesPanel = { "Gates", "what the device offers", draw, kOptions };

}  // namespace tessera::view

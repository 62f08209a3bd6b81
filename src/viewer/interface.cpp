#include "viewer/interface.h"

#include "scene/builtin.h"
#include "viewer/completion.h"
#include "viewer/gizmos.h"
#include "viewer/input.h"
#include "viewer/panels/panels.h"

#include <imgui_stdlib.h>

namespace tessera::view
{

namespace
{

constexpr float kSideBarWidth = 27;  // letters of the font's size
constexpr ImGuiWindowFlags kFixed = ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoTitleBar |
									ImGuiWindowFlags_NoSavedSettings;

void menuItem(Ui& ui, const char* name, const char* label, const char* key, bool& request)
{
	request |= ImGui::MenuItem(label, key);
	ui.note(name, "");
}

void drawMenu(Ui& ui, Session& session)
{
	if (!ImGui::BeginMainMenuBar())
		return;
	const auto menu = [&](const char* name, const char* label, const auto& content) {
		const bool open = ImGui::BeginMenu(label);
		ui.note(name, "");
		if (!open)
			return;
		content();
		ImGui::EndMenu();
	};
	Requests& requests = session.requests;
	menu("menu.file", "File", [&] {
		menuItem(ui, "menu.open", "Open ...", "Ctrl+O", session.asks_for_path);
		menuItem(ui, "menu.screenshot", "Screenshot", "F12", requests.screenshot);
		menuItem(ui, "menu.quit", "Quit", "Ctrl+Q", requests.quit);
	});
	menu("menu.camera", "Camera", [&] {
		menuItem(ui, "menu.reset", "Reset", "Home", requests.reset_camera);
		menuItem(ui, "menu.frame", "Frame", "F", requests.frame_selection);
		menuItem(ui, "menu.copy", "Copy render command", "Ctrl+C", requests.copy_command);
	});
	menu("menu.window", "Window", [&] {
		ImGui::MenuItem("Vertical sync", "V", &session.vsync, session.can_switch_vsync);
		ui.note("menu.vsync", "");
		menuItem(ui, "menu.full_screen", "Full screen", "F11", requests.switch_full_screen);
		menuItem(ui, "menu.reload", "Reload shaders", "R", requests.reload_shaders);
		bool hide = false;
		menuItem(ui, "menu.hide", "Hide panels", "F1", hide);
		session.shows_interface &= !hide;
	});
	menu("menu.help", "Keys", [&] {
		for (std::string_view line : keyHelp())
			ImGui::TextUnformatted(std::string(line).c_str());
	});
	ImGui::EndMainMenuBar();
}

// Which panels are open: a click shows one alone, with Ctrl one more.
void drawPanelButtons(Ui& ui, Session& session)
{
	if (!ImGui::BeginTable("panels", 3))
		return;
	for (const Panel& panel : panels())
	{
		ImGui::TableNextColumn();
		const std::string name(panel.name);
		bool& open = session.open_panels[name];
		if (ImGui::Selectable(name.c_str(), open))
		{
			const bool was_open = open;
			if (!ImGui::GetIO().KeyCtrl)
				for (auto& [other, other_open] : session.open_panels)
					other_open = false;
			open = !was_open || !ImGui::GetIO().KeyCtrl;
		}
		ui.note("panel." + name, std::string(panel.help) + "\nCtrl: beside those that are open");
	}
	ImGui::EndTable();
}

void drawSideBar(Ui& ui, Session& session, float top, float width)
{
	ImGui::SetNextWindowPos(ImVec2(0, top));
	ImGui::SetNextWindowSize(ImVec2(width, ImGui::GetIO().DisplaySize.y - top));
	if (ImGui::Begin("side bar", nullptr, kFixed))
	{
		drawPanelButtons(ui, session);
		ImGui::PushItemWidth(ImGui::GetFontSize() * 13);
		for (const Panel& panel : panels())
			if (session.open_panels[std::string(panel.name)])
			{
				ImGui::Separator();
				ImGui::TextDisabled("%s", std::string(panel.name).c_str());
				ImGui::PushID(panel.name.data());
				panel.draw(ui, session);
				ImGui::PopID();
			}
		ImGui::PopItemWidth();
	}
	ImGui::End();
}

std::vector<std::string> builtinNames()
{
	std::vector<std::string> names;
	for (const BuiltinScene& scene : builtinScenes())
		names.push_back(fmt::format("builtin:{}", scene.name));
	return names;
}

void drawOpenField(Ui& ui, Session& session)
{
	static const std::vector<std::string> kSuffixes = { ".gltf", ".glb" };
	const ImVec2 display = ImGui::GetIO().DisplaySize;
	ImGui::SetNextWindowPos(ImVec2(display.x / 2, display.y / 4), ImGuiCond_Always, ImVec2(0.5f, 0));
	ImGui::SetNextWindowSize(ImVec2(ImGui::GetFontSize() * 44, 0));
	if (ImGui::Begin("Open", &session.asks_for_path, ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoResize))
	{
		if (ImGui::IsWindowAppearing())
			ImGui::SetKeyboardFocusHere();
		ImGui::SetNextItemWidth(-1);
		const auto complete = [](ImGuiInputTextCallbackData* data) {
			const Completion completion = completePath(data->Buf, kSuffixes, builtinNames());
			data->DeleteChars(0, data->BufTextLen);
			data->InsertChars(0, completion.text.c_str());
			return 0;
		};
		const bool entered =
			ImGui::InputText("##path", &session.typed_path, ImGuiInputTextFlags_EnterReturnsTrue | ImGuiInputTextFlags_CallbackCompletion, complete);
		ui.note("open.path", "");
		const Completion completion = completePath(session.typed_path, kSuffixes, builtinNames());
		ImGui::TextDisabled("a .gltf or .glb file, or builtin:NAME; Tab completes, Enter opens");
		for (size_t i = 0; i < completion.files.size() && i < 12; ++i)
		{
			if (ImGui::Selectable(completion.files[i].c_str(), false, ImGuiSelectableFlags_DontClosePopups))
				session.typed_path = completion.files[i];
			ui.note(fmt::format("open.file.{}", i), "");
		}
		if (ui.button("open.do", "open", "") || entered)
		{
			session.requests.open = session.typed_path;
			session.asks_for_path = false;
		}
	}
	ImGui::End();
}

void drawMessages(const Session& session, ImVec2 low, ImVec2 size)
{
	const std::vector<std::string> warnings = viewportWarnings(session);
	const bool loads = session.loader->isLoading();
	if (warnings.empty() && !loads)
		return;
	ImGui::SetNextWindowPos(ImVec2(low.x + size.x / 2, low.y + ImGui::GetFontSize() / 2), ImGuiCond_Always, ImVec2(0.5f, 0));
	ImGui::SetNextWindowSize(ImVec2(std::min(size.x, ImGui::GetFontSize() * 48), 0));
	ImGui::SetNextWindowBgAlpha(0.8f);
	if (ImGui::Begin("messages", nullptr, kFixed | ImGuiWindowFlags_NoInputs | ImGuiWindowFlags_NoFocusOnAppearing))
	{
		ImGui::PushStyleColor(ImGuiCol_Text, ImVec4(1.0f, 0.75f, 0.35f, 1));
		for (const std::string& warning : warnings)
			ImGui::TextWrapped("%s", warning.c_str());
		ImGui::PopStyleColor();
		if (loads)
			ImGui::ProgressBar(session.loader->progress(), ImVec2(-1, 0),
							   fmt::format("{}: {}", session.loader->loading(), session.loader->step()).c_str());
	}
	ImGui::End();
}

}  // namespace

void startInterface(float scale)
{
	ImGui::CreateContext();
	ImGuiIO& io = ImGui::GetIO();
	io.IniFilename = nullptr;  // settings are ours
	ImFontConfig font;
	font.SizePixels = 13 * scale;
	io.Fonts->AddFontDefault(&font);
	ImGui::StyleColorsDark();
	ImGui::GetStyle().WindowRounding = 0;
	ImGui::GetStyle().ScaleAllSizes(scale);
}

void endInterface()
{
	ImGui::DestroyContext();
}

std::vector<std::string> viewportWarnings(const Session& session)
{
	std::vector<std::string> warnings;
	if (!session.error.empty())
		warnings.push_back(session.error);
	if (!session.shaders.error.empty())
		warnings.push_back("Shaders do not compile, the old ones stay:\n" + session.shaders.error);
	if (std::string coarse = coarseningWarning(session.shown.result); !coarse.empty())
		warnings.push_back(std::move(coarse));
	if (session.shown.result.rounds > 1)
		warnings.push_back(fmt::format("Drawn in {} rounds: clusters exceed a list", session.shown.result.rounds));
	return warnings;
}

void drawInterface(Ui& ui, Session& session, uvec2 window_px)
{
	ui.beginFrame();
	session.viewport_low = { 0, 0 };
	session.viewport_size = window_px;
	const ImGuiIO& io = ImGui::GetIO();
	ImVec2 low(0, 0), size = io.DisplaySize;
	if (session.shows_interface)
	{
		drawMenu(ui, session);
		low = ImVec2(ImGui::GetFontSize() * kSideBarWidth, ImGui::GetFrameHeight());
		size = ImVec2(std::max(io.DisplaySize.x - low.x, 1.0f), std::max(io.DisplaySize.y - low.y, 1.0f));
		drawSideBar(ui, session, low.y, low.x);
		session.viewport_low = { uint32_t(low.x * io.DisplayFramebufferScale.x), uint32_t(low.y * io.DisplayFramebufferScale.y) };
		session.viewport_size = glm::max(ivec2(window_px) - ivec2(session.viewport_low), ivec2(1));
		drawGizmos(session);
		drawMessages(session, low, size);
		if (session.asks_for_path)
			drawOpenField(ui, session);
	}
}

}  // namespace tessera::view

#include "verify/suite/suite.h"

#include "base/log.h"
#include "output/mesh_glb.h"
#include "scene/build.h"
#include "scene/gltf_import.h"
#include "verify/suite/case.h"

#include <unistd.h>

#include <algorithm>
#include <chrono>

namespace tessera::verify
{

namespace
{

std::vector<Case> allCases()
{
	std::vector<Case> cases;
	addScaleCases(cases);
	addGeometryCases(cases);
	addDisplacementCases(cases);
	addViewCases(cases);
	addCountCases(cases);
	addAnimationCases(cases);
	return cases;
}

uint64_t hostBytes()
{
	return uint64_t(::sysconf(_SC_PHYS_PAGES)) * uint64_t(::sysconf(_SC_PAGE_SIZE));
}

uint64_t deviceBytes(const Device& device)
{
	VkPhysicalDeviceMemoryProperties memory;
	vkGetPhysicalDeviceMemoryProperties(device.physical, &memory);
	uint64_t most = 0;
	for (uint32_t i = 0; i < memory.memoryHeapCount; ++i)
		if (memory.memoryHeaps[i].flags & VK_MEMORY_HEAP_DEVICE_LOCAL_BIT)
			most = std::max<uint64_t>(most, memory.memoryHeaps[i].size);
	return most;
}

// Why this machine cannot run a case; empty: it can.
std::string lacking(const Needs& needs, const Device& device)
{
	constexpr double kGiB = 1 << 30;
	if (needs.hardware && device.is_cpu)
		return "needs a hardware device";
	if (needs.device_bytes > deviceBytes(device))
		return fmt::format("needs {:.0f} GiB of device memory, there are {:.1f}", double(needs.device_bytes) / kGiB,
						   double(deviceBytes(device)) / kGiB);
	if (needs.host_bytes > hostBytes())
		return fmt::format("needs {:.0f} GiB of memory, there are {:.1f}", double(needs.host_bytes) / kGiB, double(hostBytes()) / kGiB);
	return "";
}

std::string inWords(const Expected& expected)
{
	switch (expected.kind)
	{
	case Expected::Kind::Within:
		return fmt::format("{} at most {:g}", expected.measure, expected.bound);
	case Expected::Kind::Refused:
		return fmt::format("refused with exit code {}: ... {} ...", int(expected.code), expected.says);
	default:
		return "exact";
	}
}

// The scene as a .glb file, damaged as the case says.
Result<std::vector<std::byte>> fileOf(const Case& one)
{
	TRY_ASSIGN(std::vector<std::byte> file, encodeSceneGlb(one.name, one.scene()));
	if (!one.damage)
		return file;
	const std::vector<std::byte> before = file;
	one.damage(file);
	if (file == before)
		return fail(ExitCode::CheckFailed, "{}: nothing of the file was changed", one.name);
	return file;
}

class CaseRunner
{
public:
	CaseRunner(const Case& one, const SuiteDevice& suite) : case_(one), suite_(suite)
	{
		line_.family = one.family;
		line_.name = one.name;
		line_.what = one.what;
		line_.expected = inWords(one.expected);
		line_.measure = one.expected.measure;
		line_.bound = one.expected.bound;
	}

	// Errors end the suite.
	Result<SuiteLine> run()
	{
		const auto start = std::chrono::steady_clock::now();
		const Status status = load();
		if (!status && status.error().code == ExitCode::DeviceLost)
			return tl::unexpected(status.error());
		judge(status);
		line_.passed = line_.wrong.empty();
		line_.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
		return std::move(line_);
	}

private:
	Status load()
	{
		TRY_ASSIGN(std::vector<std::byte> file, fileOf(case_));
		TRY_ASSIGN(const ImportedScene imported, importGltf(case_.name, std::move(file)));
		TRY_ASSIGN(run_.scene, buildScene(imported));
		return case_.measure ? measure() : verifyScene();
	}

	Status measure()
	{
		TRY_ASSIGN(const Measured measured, case_.measure(suite_, case_, run_.scene));
		line_.checks = measured.checks;
		line_.violations = measured.violations;
		line_.worst = measured.worst;
		line_.wrong = measured.what;
		return {};
	}

	Status verifyScene()
	{
		Request request;
		request.device = &suite_.device;
		request.scene = &run_.scene;
		request.table = &suite_.table;
		request.options = case_.options;
		request.options.rate = case_.rates.front();
		request.options.width_px = case_.width_px;
		request.options.height_px = case_.height_px;
		request.uncut_options = request.options;
		request.uncut_options.cull = { false, false, false };
		request.paths = suite_.paths;
		request.cameras = case_.cameras ? case_.cameras(run_.scene) : usualCameras();
		request.rates = case_.rates;
		request.seed = suite_.seed;
		request.usual_way = suite_.usual_way;
		request.fault = suite_.fault;
		request.one_variation = true;
		request.tells_progress = false;
		TRY_ASSIGN(run_.report, verify::run(request));
		readReport();
		return {};
	}

	std::vector<NamedCamera> usualCameras() const
	{
		std::vector<NamedCamera> cameras = { { "framing", framingCamera(run_.scene) } };
		for (NamedCamera& camera : randomCameras(run_.scene, suite_.seed, 6))
			cameras.push_back(std::move(camera));
		return cameras;
	}

	void readReport()
	{
		const Report& report = run_.report;
		line_.violations = report.violations();
		line_.usual_way = report.usual_way;
		for (const NamedCheck& check : report.checks)
		{
			line_.checks += check.result.sums.empty() ? 0 : report.frames.size() * suite_.paths.size();
			const auto measured = [&](const std::string& name) {
				const auto found = check.result.largest.find(name);
				return found == check.result.largest.end() ? 0.0 : found->second;
			};
			if (check.name != kFinite)
				continue;
			line_.error_ulp = measured("error, ulp of the largest coordinate");
			line_.error_px = measured("error, pixels");
			line_.worst = measured(case_.expected.measure);
		}
		for (const NamedCheck& check : report.checks)
			if (check.result.violations > 0 && line_.wrong.empty())
				line_.wrong = fmt::format("{} {}: {}", check.name, check.result.violations, describe(check.result.place));
		if (line_.wrong.empty() && case_.also)
			line_.wrong = case_.also(run_);
	}

	void judge(const Status& status)
	{
		const Expected& expected = case_.expected;
		if (expected.kind == Expected::Kind::Refused)
			return judgeRefusal(status);
		if (!status)
			line_.wrong = fmt::format("ended with exit code {}: {}", int(status.error().code), status.error().message);
		else if (line_.violations > 0 && line_.wrong.empty())
			line_.wrong = fmt::format("{} violations", line_.violations);
		else if (line_.wrong.empty() && !(line_.worst <= expected.bound))
			line_.wrong = fmt::format("{} is {:.3g}, at most {:.3g} is right", expected.measure, line_.worst, expected.bound);
	}

	void judgeRefusal(const Status& status)
	{
		const Expected& expected = case_.expected;
		line_.checks = 1;
		line_.worst = status ? 0 : double(status.error().code);
		const std::string message = status ? "" : status.error().message;
		const bool right = !status && status.error().code == expected.code && message.find(expected.says) != std::string::npos &&
						   message.find('\n') == std::string::npos;
		if (right)
			return;
		line_.violations = 1;
		line_.wrong = status ? "was accepted" : fmt::format("exit code {}: {}", int(status.error().code), message);
	}

	const Case& case_;
	const SuiteDevice& suite_;
	CaseRun run_;
	SuiteLine line_;
};

}  // namespace

size_t SuiteReport::failed() const
{
	return size_t(std::count_if(lines.begin(), lines.end(), [](const SuiteLine& line) { return !line.passed && line.skipped.empty(); }));
}

size_t SuiteReport::skipped() const
{
	return size_t(std::count_if(lines.begin(), lines.end(), [](const SuiteLine& line) { return !line.skipped.empty(); }));
}

std::vector<std::string> suiteFamilies()
{
	std::vector<std::string> families;
	for (const Case& one : allCases())
		if (families.empty() || families.back() != one.family)
			families.push_back(one.family);
	return families;
}

Result<SuiteReport> runSuite(const SuiteRequest& request)
{
	std::vector<Case> cases = allCases();
	std::erase_if(cases, [&](const Case& one) {
		return (request.quick && !one.quick) || !(request.only.empty() || request.only == one.family || request.only == one.name);
	});
	if (cases.empty())
		return fail(ExitCode::Usage, "--suite: no case or family is called {}; families are {}", request.only, fmt::join(suiteFamilies(), ", "));
	const SuiteDevice suite = { *request.device, *request.table, request.paths, request.seed, request.usual_way, request.fault };
	SuiteReport report = { request.quick ? "extreme-quick" : "extreme", {} };
	for (const Case& one : cases)
	{
		logInfo("case {}: {} ({} of {})", one.name, one.what, report.lines.size() + 1, cases.size());
		if (const std::string reason = lacking(one.needs, *request.device); !reason.empty())
		{
			report.lines.push_back({ one.family, one.name, one.what, reason });
			continue;
		}
		TRY_ASSIGN(SuiteLine line, CaseRunner(one, suite).run());
		if (!line.passed)
			logInfo("case {} failed: {}", one.name, line.wrong);
		report.lines.push_back(std::move(line));
	}
	return report;
}

}  // namespace tessera::verify

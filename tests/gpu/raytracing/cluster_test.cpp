#include "cluster_test.h"

#include <nlohmann/json.hpp>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <unistd.h>

namespace tessera::test
{

namespace
{

struct LayerDevice
{
	std::unique_ptr<Device> device;
	std::string reason;
	std::filesystem::path report;
};

// Made at the first use: listing the tests needs no device.
LayerDevice& processDevice()
{
	static LayerDevice made = [] {
		LayerDevice layer;
		layer.report = std::filesystem::temp_directory_path() / ("tessera_clusters_" + std::to_string(getpid()) + ".json");
		setenv("VK_INSTANCE_LAYERS", "VK_LAYER_TESSERA_cluster_emulation", 1);
		setenv("VK_ADD_LAYER_PATH", TESSERA_LAYERS, 1);
		setenv("TESSERA_CLUSTER_LAYER_REPORT", layer.report.c_str(), 1);
		setenv("TESSERA_CLUSTER_LAYER_ABORT", "1", 1);
		auto device = Device::create({ .name = "", .validate = true });
		if (device)
			layer.device = std::move(*device);
		else
			layer.reason = device.error().message;
		return layer;
	}();
	return made;
}

// When all tests are done: what the layer has to say of the whole.
class LayerReport : public testing::Environment
{
public:
	void TearDown() override
	{
		LayerDevice& layer = processDevice();
		if (!layer.device || !layer.device->gates.cluster_acceleration_structure)
			return;
		layer.device.reset();
		const auto json = nlohmann::json::parse(std::ifstream(layer.report), nullptr, false);
		std::filesystem::remove(layer.report);
		ASSERT_FALSE(json.is_discarded()) << "no report in " << layer.report;
		EXPECT_TRUE(json["violations"].empty()) << json["violations"];
		EXPECT_TRUE(json["limits"].empty()) << json["limits"];
		EXPECT_GT(json["counts"].value("commands", 0), 0) << "nothing came by the layer";
	}
};

const auto* const kLayerReport = testing::AddGlobalTestEnvironment(new LayerReport);

}  // namespace

void ClusterTest::SetUp()
{
	if (!processDevice().device)
		GTEST_SKIP() << processDevice().reason;
	if (!clusterDevice().gates.rays())
		GTEST_SKIP() << "the device cannot trace rays";
	ASSERT_TRUE(clusterDevice().gates.cluster_acceleration_structure) << clusterDevice().gates.why_no_clusters;
}

void ClusterTest::TearDown()
{
	if (!processDevice().device)
		return;
	EXPECT_EQ(clusterDevice().validationMessages(), 0u) << "the validation layer stands below the other";
}

Device& clusterDevice()
{
	return *processDevice().device;
}

const ListStats& ClusterFrame::list(std::string_view name) const
{
	static const ListStats kNone;
	const auto found = std::find_if(result.lists.begin(), result.lists.end(), [&](const ListStats& list) { return list.name == name; });
	EXPECT_NE(found, result.lists.end()) << name;
	return found == result.lists.end() ? kNone : *found;
}

std::unique_ptr<Renderer> clusterRenderer(const GpuScene& scene, const RenderOptions& options, std::vector<std::string_view> more_outputs)
{
	auto renderer = Renderer::create(clusterDevice(), scene.built, scene.table, framePasses(), options, more_outputs);
	EXPECT_TRUE(renderer) << (renderer ? "" : renderer.error().message);
	return renderer ? std::move(*renderer) : nullptr;
}

ClusterFrame drawnBy(Renderer& renderer, const Camera& camera)
{
	ClusterFrame frame;
	auto result = renderer.renderFrame(camera);
	EXPECT_TRUE(result) << (result ? "" : result.error().message);
	if (!result)
		return frame;
	auto picture = renderer.readPicture();
	EXPECT_TRUE(picture) << (picture ? "" : picture.error().message);
	return { std::move(*result), picture ? std::move(*picture) : std::vector<uint8_t>() };
}

ClusterFrame drawn(const GpuScene& scene, const RenderOptions& options, const Camera& camera)
{
	const auto renderer = clusterRenderer(scene, options);
	return renderer ? drawnBy(*renderer, camera) : ClusterFrame();
}

RenderOptions pathOptions(float rate, RayPath path, Raster raster)
{
	RenderOptions options = rayOptions(rate, raster);
	options.ray_path = path;
	return options;
}

}  // namespace tessera::test

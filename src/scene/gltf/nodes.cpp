#include "scene/gltf/nodes.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tessera
{

static constexpr const char* kInstancing = "EXT_mesh_gpu_instancing";

static dmat4 composed(dvec3 translation, dvec4 rotation, dvec3 scale)
{
	const auto [x, y, z, w] = std::array{ rotation.x, rotation.y, rotation.z, rotation.w };
	dmat4 matrix(1);
	matrix[0] = scale.x * dvec4(1 - 2 * (y * y + z * z), 2 * (x * y + z * w), 2 * (x * z - y * w), 0);
	matrix[1] = scale.y * dvec4(2 * (x * y - z * w), 1 - 2 * (x * x + z * z), 2 * (y * z + x * w), 0);
	matrix[2] = scale.z * dvec4(2 * (x * z + y * w), 2 * (y * z - x * w), 1 - 2 * (x * x + y * y), 0);
	matrix[3] = dvec4(translation, 1);
	return matrix;
}

static bool isFinite(const dmat4& matrix)
{
	for (int column = 0; column < 4; ++column)
		for (int row = 0; row < 4; ++row)
			if (!std::isfinite(static_cast<float>(matrix[column][row])))
				return false;
	return true;
}

static Result<dvec4> unitRotation(const GltfDocument& document, const std::string& place, dvec4 rotation)
{
	const double length = glm::length(rotation);
	if (!(length > 1e-12) || !std::isfinite(length))
		return document.bad(place, "has length {}, but a unit quaternion is right", length);
	return rotation / length;
}

static Result<dmat4> localMatrix(const GltfDocument& document, const std::string& place, const tinygltf::Node& node)
{
	if (!node.matrix.empty())
	{
		dmat4 matrix;
		for (size_t i = 0; i < 16; ++i)
			matrix[static_cast<int>(i / 4)][static_cast<int>(i % 4)] = node.matrix[i];
		if (matrix[0][3] != 0 || matrix[1][3] != 0 || matrix[2][3] != 0 || matrix[3][3] != 1)
			return document.bad(place + ".matrix", "its last row is {} {} {} {}, but 0 0 0 1 (affine) is right", matrix[0][3], matrix[1][3],
								matrix[2][3], matrix[3][3]);
		return matrix;
	}
	const auto vectorOr = [](const std::vector<double>& values, dvec3 otherwise) {
		return values.empty() ? otherwise : dvec3(values[0], values[1], values[2]);
	};
	dvec4 rotation(0, 0, 0, 1);
	if (!node.rotation.empty())
	{
		TRY_ASSIGN(rotation,
				   unitRotation(document, place + ".rotation", dvec4(node.rotation[0], node.rotation[1], node.rotation[2], node.rotation[3])));
	}
	return composed(vectorOr(node.translation, dvec3(0)), rotation, vectorOr(node.scale, dvec3(1)));
}

// The nodes that the walk starts from.
static std::vector<int> rootNodes(GltfDocument& document, const tinygltf::Model& model)
{
	if (!model.scenes.empty())
	{
		const size_t scene = model.defaultScene >= 0 ? static_cast<size_t>(model.defaultScene) : 0;
		if (model.scenes.size() > 1)
			document.warnings.add("scenes", fmt::format("only scene {} of {} is drawn", scene, model.scenes.size()));
		return model.scenes[scene].nodes;
	}
	std::vector<bool> is_child(model.nodes.size(), false);
	for (const tinygltf::Node& node : model.nodes)
		for (const int child : node.children)
			is_child[static_cast<size_t>(child)] = true;
	std::vector<int> roots;
	for (size_t i = 0; i < model.nodes.size(); ++i)
		if (!is_child[i])
			roots.push_back(static_cast<int>(i));
	return roots;
}

namespace
{

class NodeWalk
{
public:
	NodeWalk(GltfDocument& document, const tinygltf::Model& model, const std::vector<GltfAccessor>& accessors)
		: m_document(document), m_model(model), m_accessors(accessors)
	{}

	Result<FlatNodes> walk()
	{
		struct Step
		{
			int node;
			dmat4 parent;
		};
		std::vector<bool> reached(m_model.nodes.size(), false);
		std::vector<Step> steps;
		const std::vector<int> roots = rootNodes(m_document, m_model);
		for (auto root = roots.rbegin(); root != roots.rend(); ++root)
			steps.push_back({ *root, dmat4(1) });
		while (!steps.empty())
		{
			const Step step = steps.back();
			steps.pop_back();
			const size_t index = static_cast<size_t>(step.node);
			if (reached[index])
				return m_document.bad(fmt::format("nodes[{}]", index), "is reached twice (a cycle or a second parent); a tree is right");
			reached[index] = true;
			TRY_ASSIGN(const dmat4 world, visit(index, step.parent));
			const std::vector<int>& children = m_model.nodes[index].children;
			for (auto child = children.rbegin(); child != children.rend(); ++child)
				steps.push_back({ *child, world });
		}
		return std::move(m_flat);
	}

private:
	// Adds what the node holds; returns its world matrix.
	Result<dmat4> visit(size_t index, const dmat4& parent)
	{
		const tinygltf::Node& node = m_model.nodes[index];
		const std::string place = fmt::format("nodes[{}]", index);
		TRY_ASSIGN(const dmat4 local, localMatrix(m_document, place, node));
		const dmat4 world = parent * local;
		if (!isFinite(world))
			return m_document.bad(place, "its world matrix is not finite or too large for a 32-bit float");
		if (node.skin >= 0)
			m_document.warnings.add(place + ".skin", "skins are not supported; the mesh is drawn unskinned at its node");
		if (node.camera >= 0)
			TRY(addCamera(static_cast<size_t>(node.camera), world));
		if (node.mesh < 0)
			return world;
		if (const auto instancing = node.extensions.find(kInstancing); instancing != node.extensions.end())
			TRY(addInstances(fmt::format("{}.extensions.{}.attributes", place, kInstancing), instancing->second.Get("attributes"), node.mesh, world));
		else
			m_flat.instances.push_back({ static_cast<uint32_t>(node.mesh), world });
		return world;
	}

	// Values of one instancing attribute, `components` per instance; empty when the node lacks it.
	Result<std::vector<float>> instanceValues(const std::string& place, const tinygltf::Value& attributes, const char* name, int components,
											  size_t& count) const
	{
		if (!attributes.Has(name))
			return std::vector<float>();
		const GltfAccessor& accessor = m_accessors[static_cast<size_t>(attributes.Get(name).GetNumberAsInt())];
		const bool is_rotation = components == 4;
		const bool type_fits = accessor.isFloat() || (is_rotation && accessor.normalized &&
													  (accessor.component_type == kGltfByte || accessor.component_type == kGltfShort));
		if (accessor.components != components || !type_fits)
			return m_document.bad(fmt::format("{}.{}", place, name), "is {}, but VEC{} of FLOAT{} is right", accessor.shown(), components,
								  is_rotation ? " or of normalized BYTE or SHORT" : "");
		if (count != 0 && accessor.count != count)
			return m_document.bad(fmt::format("{}.{}", place, name), "has {} elements, but another attribute has {}", accessor.count, count);
		count = accessor.count;
		return readFloats(accessor, 0, count);
	}

	Status addInstances(const std::string& place, const tinygltf::Value& attributes, int mesh, const dmat4& world)
	{
		size_t count = 0;
		TRY_ASSIGN(const std::vector<float> translations, instanceValues(place, attributes, "TRANSLATION", 3, count));
		TRY_ASSIGN(const std::vector<float> rotations, instanceValues(place, attributes, "ROTATION", 4, count));
		TRY_ASSIGN(const std::vector<float> scales, instanceValues(place, attributes, "SCALE", 3, count));
		if (count == 0)
			return m_document.bad(place, "has none of TRANSLATION, ROTATION and SCALE, but at least one is needed");
		m_flat.instances.reserve(m_flat.instances.size() + count);
		for (size_t i = 0; i < count; ++i)
		{
			const dvec3 translation = translations.empty() ? dvec3(0) : dvec3(translations[3 * i], translations[3 * i + 1], translations[3 * i + 2]);
			const dvec3 scale = scales.empty() ? dvec3(1) : dvec3(scales[3 * i], scales[3 * i + 1], scales[3 * i + 2]);
			dvec4 rotation(0, 0, 0, 1);
			if (!rotations.empty())
			{
				const dvec4 stored(rotations[4 * i], rotations[4 * i + 1], rotations[4 * i + 2], rotations[4 * i + 3]);
				TRY_ASSIGN(rotation, unitRotation(m_document, fmt::format("{}.ROTATION, element {}", place, i), stored));
			}
			const dmat4 instance = world * composed(translation, rotation, scale);
			if (!isFinite(instance))
				return m_document.bad(place, "the matrix of instance {} is not finite or too large for a 32-bit float", i);
			m_flat.instances.push_back({ static_cast<uint32_t>(mesh), instance });
		}
		return {};
	}

	Status addCamera(size_t index, const dmat4& world)
	{
		const tinygltf::Camera& source = m_model.cameras[index];
		const std::string place = fmt::format("cameras[{}]", index);
		FileCamera camera;
		camera.name = source.name;
		camera.world = world;
		camera.orthographic = source.type == "orthographic";
		if (camera.orthographic)
		{
			camera.height_world = 2 * std::fabs(source.orthographic.ymag);
			camera.near_world = std::max(source.orthographic.znear, 0.0);
			if (!(camera.height_world > 0) || !std::isfinite(static_cast<float>(camera.height_world)))
				return m_document.bad(place + ".orthographic.ymag", "is {}, but a number other than 0 is right", source.orthographic.ymag);
		}
		else
		{
			camera.fov_y_rad = source.perspective.yfov;
			camera.near_world = source.perspective.znear;
			if (!(camera.fov_y_rad > 0) || camera.fov_y_rad >= std::numbers::pi)
				return m_document.bad(place + ".perspective.yfov", "is {}, but an angle above 0 and below pi is right", camera.fov_y_rad);
			if (!(camera.near_world > 0))
				return m_document.bad(place + ".perspective.znear", "is {}, but a distance above 0 is right", camera.near_world);
		}
		m_flat.cameras.push_back(std::move(camera));
		return {};
	}

	GltfDocument& m_document;
	const tinygltf::Model& m_model;
	const std::vector<GltfAccessor>& m_accessors;
	FlatNodes m_flat;
};

}  // namespace

Result<FlatNodes> flattenNodes(GltfDocument& document, const tinygltf::Model& model, const std::vector<GltfAccessor>& accessors)
{
	return NodeWalk(document, model, accessors).walk();
}

}  // namespace tessera

#include "app/commands.h"
#include "app/export_mesh.h"
#include "app/option_text.h"
#include "app/scene_load.h"
#include "base/log.h"
#include "output/mesh_glb.h"
#include "pipeline/passes.h"

namespace tessera
{

namespace
{

Status exportBase(const CommandLine& line)
{
	if (!line.output.ends_with(".glb"))
		return fail(ExitCode::Usage, "export: -o {} must name a .glb file: --base keeps materials and instances", line.output);
	TRY_ASSIGN(const ImportedScene scene, importScene(line.scene, line.options));
	for (const std::string& warning : scene.warnings)
		logWarning("{}", warning);
	TRY(writeSceneGlb(line.output, scene));
	logInfo("wrote {}", line.output);
	return {};
}

// The rate must be the one that was asked for, or the file says nothing about it.
Status checkGranted(const FrameResult& result, bool strict)
{
	if (result.coarsening == 0 && !result.every_factor_one)
		return {};
	const std::string text = fmt::format("the rate was coarsened from {:.4g} to {}; --capacity makes a list larger", result.rate_wanted,
										 result.every_factor_one ? "factor 1 everywhere" : fmt::format("{:.4g} pixels", result.rate_granted));
	if (strict)
		return fail(ExitCode::Coarsened, "--strict: {}", text);
	logWarning("{}", text);
	return {};
}

// Draws one frame and welds what it draws. The renderer is gone when this returns.
Status drawMesh(const Subject& subject, const AppOptions& options, Device& device, MeshWelder& mesh)
{
	RenderOptions frame = options;
	frame.smooth_normals = true;  // faceted shading has no normals to write
	frame.ray_falloff = 0;        // the mesh is seen from elsewhere later
	TRY_ASSIGN(const std::unique_ptr<Renderer> renderer, Renderer::create(device, subject.scene, subject.table, framePasses(), frame, kDumpOutputs));
	const auto readRound = [&](uint32_t round) -> Status {
		if (round == 0)
			mesh = {};
		TRY_ASSIGN(const FrameDump dump, readDump(*renderer));
		addToMesh(subject.scene, dump, mesh);
		return {};
	};
	TRY_ASSIGN(const FrameResult result, renderer->renderFrame(subject.camera, readRound));
	return checkGranted(result, options.strict);
}

Status exportMicro(const CommandLine& line)
{
	TRY_ASSIGN(const Subject subject, loadSubject(line.scene, line.options));
	TRY_ASSIGN(const std::unique_ptr<Device> device, Device::create({ line.options.device, line.options.validate }));
	logInfo("device {}, driver {}", device->name, device->driver);
	MeshWelder mesh;
	TRY(drawMesh(subject, line.options, *device, mesh));
	const MeshView view = mesh.view(hasUvs(subject.scene));
	if (view.indices.empty())
		return badInput("{}: the frame has no micro-triangles to write", subject.scene.path);
	TRY(line.output.ends_with(".glb") ? writeMeshGlb(line.output, view) : writePly(line.output, view));
	logInfo("wrote {}: {} vertices, {}", line.output, view.positions.size(), counted(view.indices.size() / 3, "triangle"));
	if (mesh.collapsedTriangles() > 0)
		logInfo("left out {} of which two corners coincide", counted(mesh.collapsedTriangles(), "triangle"));
	if (const uint32_t count = device->validationMessages())
		return fail(ExitCode::CheckFailed, "--validate: the validation layer had {}", counted(count, "message"));
	return {};
}

}  // namespace

Status exportCommand(const CommandLine& line)
{
	if (!line.output.ends_with(".glb") && !line.output.ends_with(".ply"))
		return fail(ExitCode::Usage, "export: -o {} must name a .glb or .ply file", line.output.empty() ? "(missing)" : line.output);
	return line.base ? exportBase(line) : exportMicro(line);
}

}  // namespace tessera

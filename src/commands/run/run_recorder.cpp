#include "commands/run/run_recorder.h"

#include <iostream>

#include "commands/shared/output_names.h"
#include "platform/files.h"
#include "platform/process.h"
#include "scene/scene_file.h"
#include "text/error.h"
#include "text/text.h"

namespace mssim {

void require_distinct(const RunFiles& files, const SceneSpec& scene) {
  std::vector<NamedFile> written, read;
  if (!files.trace.empty()) {
    written.push_back({"--trace", files.trace});
    written.push_back({"the XDMF beside --trace", xdmf_of(files.trace)});
  }
  if (!files.energy_curve.empty()) written.push_back({"--energy-curve", files.energy_curve});
  if (!files.pictures.empty()) written.push_back({"--pictures", files.pictures});
  for (const std::filesystem::path& file : files_of(scene)) read.push_back({"a file of the scene", file});
  require_distinct(written, read);
}

RunRecorder::RunRecorder(const RunFiles& files, const PreparedScene& scene, const FileHeaders& headers)
    : temporary_(files.temporary) {
  if (!files.energy_curve.empty()) {
    std::string comment = headers.command_line;
    if (const std::string_view work = energies_leave_out(scene.system); !work.empty())
      comment.append("\nleft out: ").append(work);
    curve_.emplace(files.energy_curve, comment);
  }
  const Surface body = scene.body ? scene.body->surface : Surface{};
  if (!files.trace.empty()) trace_.emplace(files.trace, scene.system, headers.trace, body);
  if (!files.pictures.empty())
    pictures_.emplace(files.pictures, trace_content_of(scene.system, headers.trace, body), headers.pictures);
}

void RunRecorder::record(const Frame& frame) {
  const EnergySample sample{frame.time_s, frame.energy};
  // First the curve, so that it has the energies of every frame of the trace, whichever of the two fails.
  if (curve_) curve_->append(sample);
  if (trace_) trace_->write_frame(frame.step, frame.time_s, frame.state, frame.energy, frame.losses);
  if (pictures_) pictures_->draw(frame.state.position);
  energies_.push_back(sample);
}

void RunRecorder::finish_after(const std::function<void()>& simulation) {
  try {
    try {
      simulation();
    } catch (const NotVerified&) {
      finish();
      throw;
    } catch (const Interrupted&) {
      finish();
      throw;
    }
    finish();
  } catch (const WriteError& error) {
    throw WriteError(error.what() + kept());
  }
}

void RunRecorder::finish() {
  if (curve_) curve_->close();
  if (trace_) trace_->close();
  if (temporary_) return;
  const auto tell = [](const std::string& what) { std::cerr << "mssim: wrote " << what << '\n'; };
  if (curve_) tell(printable(curve_->name().string(), 1000));
  if (trace_)
    tell(printable(trace_->name().string(), 1000) + " and " +
         printable(xdmf_of(trace_->name()).string(), 1000));
  if (pictures_)
    tell(pluralize(pictures_->pictures(), "picture") + " into " +
         printable(pictures_->name().string(), 1000));
}

std::string RunRecorder::kept() {
  std::string text;
  if (temporary_) return text;
  if (trace_) text += kept_in_part(trace_->name(), "frames", trace_->give_up());
  if (curve_) text += kept_in_part(curve_->name(), "energies", curve_->give_up());
  return text;
}

}  // namespace mssim

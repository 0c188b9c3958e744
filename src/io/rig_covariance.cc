#include <utility>

#include "covariance_yaml.h"
#include "rig_formats.h"

namespace stereomotion {

RigCovariance ReadRigCovariance(const YamlReader& node, const Rig& rig) {
  std::vector<std::string> names;
  std::vector<RigParameter> known;
  for (int camera = 0; camera < static_cast<int>(rig.cameras.size()); ++camera) {
    for (int index = 0; index < RigParameter::kPerCamera; ++index) {
      known.push_back({camera, index});
      names.push_back(RigParameterName(rig, known.back()));
    }
  }
  NamedCovariance named = ReadNamedCovariance(node, names, "a camera's parameter");
  RigCovariance covariance;
  for (const std::size_t place : named.places) covariance.parameters.push_back(known[place]);
  covariance.matrix = std::move(named.matrix);
  return covariance;
}

}  // namespace stereomotion

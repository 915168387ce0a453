// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "zoneplate/evaluate/dataset/sequence.h"
#include "zoneplate/evaluate/dataset/shots.h"
#include "zoneplate/math/mat.h"
#include "zoneplate/report/json.h"

namespace zoneplate {

/// The JSON file of a sequence in the layout of Arm's neural-graphics-model-gym.
///
/// Source    docs/nss/nss_dataset_specification.md there, version 1.0.1.
std::string nss_json(const DatasetSequence& sequence, Shots& shots);

/// The matrix that multiplies column vectors, column by column.
Json::Array columns_of(const float4x4& m);

}  // namespace zoneplate

// SPDX-License-Identifier: Apache-2.0
import zoneplate from './index.cjs';

export const { render, renderFiles, info, compare, list, setWorkers, close, ZoneplateError } = zoneplate;

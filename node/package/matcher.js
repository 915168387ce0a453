// SPDX-License-Identifier: Apache-2.0
import matcher from './matcher.cjs';

export const { toMatchRender } = matcher;

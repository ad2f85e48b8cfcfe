/** `/replay/NAME`: a recorded walk that a server plays. */

import "../everyone";
import { canDraw, element, publishNothing } from "../dom";
import { askedName } from "../session";
import { publishViewer } from "../support";
import { Drop } from "./drop";
import { ReplayPage } from "./page";
import { Served } from "./served";
import { Taking } from "./taking";

const name = askedName() ?? "";
new Drop();
new Taking(name);
if (canDraw(element("notice", HTMLElement))) publishViewer(new ReplayPage(new Served(name)));
else publishNothing();

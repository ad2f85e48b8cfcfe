/** `/replay/NAME`: a recorded walk that a server plays. */

import "../everyone";
import { canDraw, element, publishNothing } from "../dom";
import { askedName } from "../session";
import { Drop } from "./drop";
import { ReplayPage } from "./page";
import { Served } from "./served";
import { publish } from "./support";
import { Taking } from "./taking";

const name = askedName() ?? "";
new Drop();
new Taking(name);
if (canDraw(element("notice", HTMLElement))) publish(new ReplayPage(new Served(name)));
else publishNothing();

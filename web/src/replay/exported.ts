/** A recorded walk as one file: this script and its data are in the page itself. */

import "../everyone";
import "../style.css";
import "./replay.css";
import { canDraw, element, publishNothing } from "../dom";
import { publishViewer } from "../support";
import { Inlined } from "./inlined";
import { ReplayPage } from "./page";

document.body.classList.add("alone");
const [facts, frames] = ["walk-facts", "walk-frames"].map((id) => element(id, HTMLScriptElement).text);
if (canDraw(element("notice", HTMLElement))) publishViewer(new ReplayPage(new Inlined(facts ?? "", frames ?? "")));
else publishNothing();

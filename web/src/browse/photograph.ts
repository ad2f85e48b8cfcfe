/** A picture of the view to take home, with whose work it shows. DOM only. */

const MARGIN_SHARE = 0.012;

/** Write a line in the lower left corner of a picture. */
export function signed(picture: HTMLCanvasElement, text: string): void {
  const context = picture.getContext("2d");
  if (!context) return;
  const size = Math.max(11, Math.round(picture.height * 0.018));
  const margin = Math.round(picture.width * MARGIN_SHARE);
  context.font = `${size}px system-ui, "DejaVu Sans", sans-serif`;
  context.textBaseline = "bottom";
  context.shadowColor = "rgb(0 0 0 / 80%)";
  context.shadowBlur = size / 2;
  context.fillStyle = "#fff";
  context.fillText(text, margin, picture.height - margin, picture.width - 2 * margin);
}

/** Hand a picture to the visitor as a file. */
export async function save(picture: HTMLCanvasElement, name: string): Promise<void> {
  const blob = await new Promise<Blob | null>((resolve) => picture.toBlob(resolve, "image/png"));
  if (!blob) throw new Error("the browser made no picture");
  const link = document.createElement("a");
  link.href = URL.createObjectURL(blob);
  link.download = name;
  link.click();
  // a browser that still reads it at once is done with it long before
  window.setTimeout(() => URL.revokeObjectURL(link.href), 60_000);
}

// Passes what one player of a comparison shows to the others.
const frames = [...document.querySelectorAll("iframe")];
addEventListener("message", (event) => {
  if (!frames.some((frame) => frame.contentWindow === event.source)) return;
  for (const frame of frames) if (frame.contentWindow !== event.source) frame.contentWindow.postMessage(event.data, "*");
});

// Asked for first: a browser that draws without a graphics processor needs a second for it, and fetches the other modules meanwhile.
export const gl = document.getElementById("scene").getContext("webgl2", { antialias: false, alpha: false, depth: false });

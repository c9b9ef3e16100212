/** Waiting for the graphics card without holding the page up. */

const POLL_MS = 10;

/** Once the graphics card has done all that it was told so far: a question about a shader would wait for that. */
export async function gpuFinished(gl: WebGL2RenderingContext): Promise<void> {
  const fence = gl.fenceSync(gl.SYNC_GPU_COMMANDS_COMPLETE, 0);
  gl.flush();
  while (
    fence !== null &&
    !gl.isContextLost() &&
    gl.getSyncParameter(fence, gl.SYNC_STATUS) !== gl.SIGNALED
  ) {
    await new Promise((resolve) => setTimeout(resolve, POLL_MS));
  }
  gl.deleteSync(fence);
}

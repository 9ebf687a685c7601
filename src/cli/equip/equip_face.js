/* SPDX-License-Identifier: Apache-2.0 */
/* From a triangle that was clicked to the rectangle of a display: all of its part that hangs
   together with it and lies as it does, and the upright rectangle around that. */
var equipFace=(function(){
var view=equipView,LIKE=Math.cos(5*Math.PI/180),LEVEL=0.99;
var STEPS=128; /* of the grid that finds what fits inside */

function corner(vertex){
  var p=view.position;
  return new THREE.Vector3(p[3*vertex],p[3*vertex+1],p[3*vertex+2]);
}
function normalOf(t){
  var i=view.index,a=corner(i[3*t]);
  return corner(i[3*t+1]).sub(a).cross(corner(i[3*t+2]).sub(a));
}
/* Corners at one place are one, also where a seam of texture coordinates parts them. */
function placeOf(vertex){
  var s=view.steps;
  return s[0][vertex]+'|'+s[1][vertex]+'|'+s[2][vertex];
}
function neighbours(part){
  var at=new Map();
  for(var t=part.first;t<part.first+part.count;t++)
    for(var k=0;k<3;k++){
      var place=placeOf(view.index[3*t+k]);
      if(!at.has(place))at.set(place,[]);
      at.get(place).push(t);
    }
  return at;
}
/* Within 5 degrees of the first one, whichever way they are wound. */
function flood(first){
  var part=view.data.parts[view.partOf[first]],at=neighbours(part);
  var along=normalOf(first).normalize(),seen=new Set([first]),found=[first];
  for(var i=0;i<found.length;i++)
    for(var k=0;k<3;k++)
      for(var t of at.get(placeOf(view.index[3*found[i]+k]))){
        if(seen.has(t))continue;
        seen.add(t);
        var n=normalOf(t),length=n.length();
        if(!length||Math.abs(n.dot(along))>=LIKE*length)found.push(t);
      }
  return found;
}
/* The sum of the areas as vectors, all on the side of whoever clicked. */
function meanNormal(triangles,towards){
  var sum=new THREE.Vector3();
  for(var t of triangles){
    var n=normalOf(t);
    sum.addScaledVector(n,n.dot(towards)<0?-1:1);
  }
  return sum.normalize();
}
/* Right is level; of a face that lies flat, it is the viewer's right. */
function axes(normal,from,middle){
  var up=new THREE.Vector3(0,1,0);
  if(Math.abs(normal.y)>LEVEL){
    up=middle.clone().sub(from).setY(0);
    if(!up.length())up.set(0,0,-1);
    if(normal.y<0)up.negate();
  }
  var right=up.cross(normal).normalize();
  return {right:right,up:normal.clone().cross(right).normalize()};
}
/* Which corners of a grid over the unit square lie in one of the triangles. */
function covered(flat){
  var wide=STEPS+1,found=new Uint8Array(wide*wide),rim=1e-3;
  flat.forEach(function(p){
    var d=(p[1][0]-p[0][0])*(p[2][1]-p[0][1])-(p[2][0]-p[0][0])*(p[1][1]-p[0][1]);
    if(!d)return;
    var from=[0,1].map(function(i){
      return Math.max(0,Math.ceil((Math.min(p[0][i],p[1][i],p[2][i])-rim)*STEPS));
    }),to=[0,1].map(function(i){
      return Math.min(STEPS,Math.floor((Math.max(p[0][i],p[1][i],p[2][i])+rim)*STEPS));
    });
    for(var y=from[1];y<=to[1];y++)
      for(var x=from[0];x<=to[0];x++){
        var s=x/STEPS-p[0][0],t=y/STEPS-p[0][1];
        var b=(s*(p[2][1]-p[0][1])-t*(p[2][0]-p[0][0]))/d;
        var c=(t*(p[1][0]-p[0][0])-s*(p[1][1]-p[0][1]))/d;
        if(b>=-rim&&c>=-rim&&b+c<=1+rim)found[y*wide+x]=1;
      }
  });
  return found;
}
/* The largest rectangle of cells whose four corners are covered: over each row, bars of covered
   cells, of which the largest rectangle is kept by a stack. */
function largest(found){
  var wide=STEPS+1,high=new Uint16Array(wide),best={area:0};
  for(var y=0;y<STEPS;y++){
    var stack=[];
    for(var x=0;x<=STEPS;x++){
      var at=y*wide+x,is=x<STEPS&&found[at]&&found[at+1]&&found[at+wide]&&found[at+wide+1];
      high[x]=is?high[x]+1:0;
      var left=x;
      while(stack.length&&stack[stack.length-1].high>=high[x]){
        var bar=stack.pop(),area=bar.high*(x-bar.left);
        left=bar.left;
        if(area>best.area)best={area:area,left:left,right:x,bottom:y+1-bar.high,top:y+1};
      }
      stack.push({left:left,high:high[x]});
    }
  }
  return best;
}
/* The upright rectangle that fits into the face, within 1/128 of its size; null: none does. */
function inside(triangles,centre,a,width,height){
  var best=largest(covered(triangles.map(function(t){
    return [0,1,2].map(function(k){
      var d=corner(view.index[3*t+k]).sub(centre);
      return [d.dot(a.right)/width+0.5,d.dot(a.up)/height+0.5];
    });
  })));
  if(!best.area)return null;
  return {dx:width*((best.left+best.right)/2/STEPS-0.5),
    dy:height*((best.bottom+best.top)/2/STEPS-0.5),
    width:width*(best.right-best.left)/STEPS,height:height*(best.top-best.bottom)/STEPS};
}
function fit(hit){
  var triangles=flood(hit.triangle);
  var normal=meanNormal(triangles,hit.normal);
  var a=axes(normal,hit.from,hit.point),low=[Infinity,Infinity],high=[-Infinity,-Infinity];
  var deep=-Infinity;
  for(var t of triangles)
    for(var k=0;k<3;k++){
      var d=corner(view.index[3*t+k]).sub(hit.point);
      [a.right,a.up].forEach(function(axis,i){
        low[i]=Math.min(low[i],d.dot(axis));
        high[i]=Math.max(high[i],d.dot(axis));
      });
      deep=Math.max(deep,d.dot(normal));
    }
  var centre=hit.point.clone().addScaledVector(a.right,(low[0]+high[0])/2)
    .addScaledVector(a.up,(low[1]+high[1])/2).addScaledVector(normal,deep);
  return {on:view.data.parts[view.partOf[hit.triangle]].name,triangles:triangles.length,
    centre:centre,right:a.right,up:a.up,width:high[0]-low[0],height:high[1]-low[1],
    inside:function(){
      return inside(triangles,centre,a,high[0]-low[0],high[1]-low[1]);
    }};
}
return {fit:fit};
})();
